#pragma once
/// The queries on which methods are measured: pairs of two bodies, or a number, at poses of several classes,
/// with the right answers. A data set has its own file, so that worker programs can read it.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/methods/method.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/enum_names.hpp>

namespace lrb::bench {

using lrb::name_of;  // the overload for enums, beside those for records

using methods::Quantity;

/// The choice of poses or motion. Distances are in diagonals of the larger body.
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
  into,         ///< B moves straight towards A and into it
  graze,        ///< B passes A and penetrates it by a hundredth
  past,         ///< B passes A at a hundredth, along some direction
  near_1000th,  ///< near pairs within a thousandth; B is half of it away, along some direction
  near_100th,
  near_20th,
};
constexpr auto enum_names(PoseClass) {
  return std::to_array<EnumName<PoseClass>>({{PoseClass::apart, "apart"},
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
                                             {PoseClass::past, "past"},
                                             {PoseClass::near_1000th, "near_1000th"},
                                             {PoseClass::near_100th, "near_100th"},
                                             {PoseClass::near_20th, "near_20th"}});
}
/// Returns the pose classes used for a quantity, in their order.
std::span<const PoseClass> classes_of(Quantity quantity);
const char* title(PoseClass c);  ///< "0.5 % apart"
/// Returns the distance within which pairs are near, in diagonals of the larger body; 0 for other classes.
double within_of(PoseClass c);

/// The file of an LRB-rep, and the cost of building it.
struct BodyFile {
  std::string file;  ///< .lrb, relative to the data set's file
  std::uint32_t faces = 0;
  double build_seconds = 0;
};

/// An interval that contains a number. Without a first contact both ends are kNever.
struct KnownNumber {
  double least = 0, most = 0;
};

struct Question {
  PoseClass pose_class = PoseClass::apart;
  std::size_t a = 0, b = 0;  ///< indices into DataSet::bodies
  Pose pose_a, pose_b;
  std::vector<SimplexPair> expected;           ///< if the quantity is a list; ascending; see bench_runner.hpp
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};  ///< first contact: translation from pose_b at t = 0 and 1
  std::optional<KnownNumber> number = {};      ///< the right answer if the quantity is a number
};

struct DataSet {
  std::string name;                     ///< for files and the command line: "rocks"
  std::string what;                     ///< description: "two rocks of 20,480 faces"
  Quantity quantity = Quantity::pairs;  ///< the queried quantity
  double diagonal = 0;                  ///< of the larger body's box
  std::vector<BodyFile> bodies;
  std::vector<Question> questions;
  std::string folder;  ///< folder of the file; not stored in it
};

/// Returns true if all queries have a right answer.
bool is_complete(const DataSet& set);

/// Writes folder/name.set.json and returns its path.
std::string write_data_set(const DataSet& set, const std::string& folder);
/// Reads a data set. Throws InputError that names the file.
DataSet read_data_set(const std::string& path);

/// Computes the numbers that a data set needs: lrbscope's intervals at their narrowest, as returned by the
/// worker of methods that return a number. Throws EnvironmentError if that program is missing, and
/// InputError, which names the query, if a query has no answer.
void find_numbers(DataSet& set);

}  // namespace lrb::bench
