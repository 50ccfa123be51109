#pragma once
/// What methods are asked when they are measured: two bodies at poses of several classes, with the exact
/// answers. A data set is a file of its own, so that worker programs can read it.

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/core/enum_words.hpp"
#include "engine/query/collide.hpp"

namespace lrb::bench {

using lrb::name_of;  // that of enums, beside those of records

/// How a pose was chosen; distances are in diagonals of the larger body.
enum class PoseClass : std::uint8_t { apart, shallow, deep, identical, small };
inline constexpr PoseClass kPoseClasses[] = {PoseClass::apart, PoseClass::shallow, PoseClass::deep,
                                             PoseClass::identical, PoseClass::small};
constexpr auto words_of(PoseClass) {
  return std::to_array<EnumWord<PoseClass>>({{PoseClass::apart, "apart"},
                                             {PoseClass::shallow, "shallow"},
                                             {PoseClass::deep, "deep"},
                                             {PoseClass::identical, "identical"},
                                             {PoseClass::small, "small"}});
}
const char* title(PoseClass c);  ///< "0.5 % apart"

/// An LRB-rep in a file, and what it took to make it.
struct BodyFile {
  std::string file;  ///< .lrb, relative to the data set's
  std::uint32_t faces = 0;
  double build_seconds = 0;
};

struct Question {
  PoseClass pose_class = PoseClass::apart;
  std::size_t a = 0, b = 0;  ///< indices into DataSet::bodies
  Pose pose_a, pose_b;
  std::vector<SimplexPair> expected;  ///< ascending; see oracle.hpp
};

struct DataSet {
  std::string name;     ///< for files and the command line: "rocks"
  std::string what;     ///< for people: "two rocks of 20,480 faces"
  double diagonal = 0;  ///< of the larger body's box
  std::vector<BodyFile> bodies;
  std::vector<Question> questions;
  std::string folder;  ///< the one it was read from; not in the file
};

/// Returns the 3x4 matrix, row by row.
nlohmann::ordered_json pose_json(const Pose& p);

/// Writes folder/name.set.json and returns its path.
std::string write_data_set(const DataSet& set, const std::string& folder);
/// Reads a data set. Throws InputError that names the file.
DataSet read_data_set(const std::string& path);

}  // namespace lrb::bench
