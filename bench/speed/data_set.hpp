#pragma once
/// What methods are asked when they are measured: for the pairs of two bodies, or a number, at poses of
/// several classes, with the right answers. A data set is a file of its own, so that worker programs can read
/// it.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/rivals/method.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/enum_words.hpp>

namespace lrb::bench {

using lrb::name_of;  // that of enums, beside those of records

using methods::Quantity;

/// How poses or a motion were chosen; distances are in diagonals of the larger body.
enum class PoseClass : std::uint8_t {
  apart,
  shallow,
  deep,
  identical,
  small,
  gap_1000th,  ///< of the diagonal, along some direction
  gap_100th,
  gap_10th,
  gap_whole,
  into,   ///< B goes straight at A, and on into it
  graze,  ///< B goes past A and into it by a hundredth
  past,   ///< B goes past A a hundredth away, at the nearest along some direction
};
constexpr auto words_of(PoseClass) {
  return std::to_array<EnumWord<PoseClass>>({{PoseClass::apart, "apart"},
                                             {PoseClass::shallow, "shallow"},
                                             {PoseClass::deep, "deep"},
                                             {PoseClass::identical, "identical"},
                                             {PoseClass::small, "small"},
                                             {PoseClass::gap_1000th, "gap_1000th"},
                                             {PoseClass::gap_100th, "gap_100th"},
                                             {PoseClass::gap_10th, "gap_10th"},
                                             {PoseClass::gap_whole, "gap_whole"},
                                             {PoseClass::into, "into"},
                                             {PoseClass::graze, "graze"},
                                             {PoseClass::past, "past"}});
}
/// Returns the classes that are asked for something, in their order.
std::span<const PoseClass> classes_of(Quantity quantity);
const char* title(PoseClass c);  ///< "0.5 % apart"

/// An LRB-rep in a file, and what it took to make it.
struct BodyFile {
  std::string file;  ///< .lrb, relative to the data set's
  std::uint32_t faces = 0;
  double build_seconds = 0;
};

/// Doubles that hold a number; a first contact that there is none of is at kNever.
struct KnownNumber {
  double least = 0, most = 0;
};

struct Question {
  PoseClass pose_class = PoseClass::apart;
  std::size_t a = 0, b = 0;  ///< indices into DataSet::bodies
  Pose pose_a, pose_b;
  std::vector<SimplexPair> expected;           ///< ascending; see bench_runner.hpp
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};  ///< first contact: where B is at t = 0 and 1, beside pose_b
  std::optional<KnownNumber> number = {};      ///< what is asked for if it is a number
};

struct DataSet {
  std::string name;                     ///< for files and the command line: "rocks"
  std::string what;                     ///< for people: "two rocks of 20,480 faces"
  Quantity quantity = Quantity::pairs;  ///< what is asked for
  double diagonal = 0;                  ///< of the larger body's box
  std::vector<BodyFile> bodies;
  std::vector<Question> questions;
  std::string folder;  ///< the one it was read from; not in the file
};

/// Returns true if all right answers are there.
bool is_complete(const DataSet& set);

/// Returns the 3x4 matrix, row by row.
nlohmann::ordered_json pose_json(const Pose& p);

/// Writes folder/name.set.json and returns its path.
std::string write_data_set(const DataSet& set, const std::string& folder);
/// Reads a data set. Throws InputError that names the file.
DataSet read_data_set(const std::string& path);

/// Fills in the numbers that a data set asks for: our own intervals at their narrowest, as the worker of
/// methods that answer with a number finds them. Throws EnvironmentError if that is not there, and
/// InputError, which names the question, for one that has no answer.
void find_numbers(DataSet& set);

}  // namespace lrb::bench
