#pragma once
/// The queries on which methods are measured: pairs of two bodies, or a number, at poses of several classes,
/// with the right answers. A data set has its own file, so that worker programs can read it.
/// Raw records: the answer of a method to a query, its time and its errors. A file contains one JSON object
/// per line. All other results are computed from these.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/methods/method.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/enum_names.hpp>

namespace lrb::speed {

using lrb::name_of;  // the overload for enums, beside those for records

using methods::Outcome, methods::Quantity;

/// The choice of poses or motion.
enum class PoseClass : std::uint8_t {
  apart,
  shallow,
  deep,
  identical,
  small,
  gap_1000th,
  gap_100th,
  gap_10th,
  gap_whole,
  into,  ///< B moves straight towards A and into it
  graze,
  past,
  near_1000th,  ///< near pairs; B is half of the distance away, along some direction
  near_100th,
  near_20th,
  interlocked,  ///< distance of bodies that reach through each other
};
struct PoseInfo {
  PoseClass value;
  const char *name, *title;
  double
      depth;  ///< the motion of B beyond first contact, in diagonals of the larger body; negative: separate
  double within = 0;  ///< the distance within which pairs are near, in diagonals of the larger body
};
inline constexpr auto kPoseInfos =
    std::to_array<PoseInfo>({{PoseClass::apart, "apart", "0.5 % apart", -0.005},
                             {PoseClass::shallow, "shallow", "shallow, 1 %", 0.01},
                             {PoseClass::deep, "deep", "deep, 10 %", 0.1},
                             {PoseClass::identical, "identical", "identical pose", 0.01},
                             {PoseClass::small, "small", "one body small", 0.01},
                             {PoseClass::gap_1000th, "gap_1000th", "0.1 % apart", -0.001},
                             {PoseClass::gap_100th, "gap_100th", "1 % apart", -0.01},
                             {PoseClass::gap_10th, "gap_10th", "10 % apart", -0.1},
                             {PoseClass::gap_whole, "gap_whole", "100 % apart", -1},
                             {PoseClass::into, "into", "straight in", 0.1},
                             {PoseClass::graze, "graze", "grazing, 1 %", 0.01},
                             {PoseClass::past, "past", "past, 1 % away", -0.01},
                             {PoseClass::near_1000th, "near_1000th", "within 0.1 %", -0.0005, 0.001},
                             {PoseClass::near_100th, "near_100th", "within 1 %", -0.005, 0.01},
                             {PoseClass::near_20th, "near_20th", "within 5 %", -0.025, 0.05},
                             {PoseClass::interlocked, "interlocked", "interlocked", 0}});
constexpr auto enum_names(PoseClass) {
  std::array<EnumName<PoseClass>, kPoseInfos.size()> out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {kPoseInfos[i].value, kPoseInfos[i].name};
  return out;
}
constexpr const PoseInfo& info_of(PoseClass c) {
  return kPoseInfos[static_cast<std::size_t>(c)];
}
/// Returns the pose classes used for a quantity, in their order.
std::span<const PoseClass> classes_of(Quantity quantity);

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

/// Computes the numbers that a data set needs: lrbscope's intervals at their narrowest, as returned by a
/// worker. Throws EnvironmentError if that program is missing, and
/// InputError, which names the query, if a query has no answer.
void find_numbers(DataSet& set);

// Errors.

/// An error measure, from 0 (exact) to its worst value, which is the score of an unanswered query.
enum class Metric : std::uint8_t {
  contact,    ///< reports contact of disjoint bodies, or the reverse
  precision,  ///< share of the reported pairs that do not intersect (1 - precision)
  recall,     ///< share of the intersecting pairs that were not reported (1 - recall)
  hausdorff,  ///< distance of the contact regions
  deviation,  ///< distance of the answer's points from both bodies
  length,
  area,
  centroid,
  normal,
  depth,
  distance,        ///< error of the distance, for methods compared on it
  time_of_impact,  ///< error of the time of first contact, for methods compared on it
  penetration,     ///< error of the penetration depth, for methods compared on it
  list,            ///< pairs in one list only, for methods compared on near pairs
};

struct MetricInfo {
  Metric metric;
  const char* name;  ///< in files and tables
  const char* what;  ///< with its unit
  double worst;
};
inline constexpr auto kMetricInfos = std::to_array<MetricInfo>({
    {Metric::contact, "contact", "fraction of poses with a false or a missed contact", 1},
    {Metric::precision, "precision",
     "1 - precision: fraction of the listed pairs that do not intersect or are not near", 1},
    {Metric::recall, "recall", "1 - recall: fraction of the intersecting or near pairs that are not listed",
     1},
    {Metric::hausdorff, "hausdorff",
     "Hausdorff distance of the contact regions, relative to the larger body's diagonal", 1},
    {Metric::deviation, "off",
     "largest sum of the distances of a point of the result from the two bodies, relative to the diagonal",
     1},
    {Metric::length, "length", "error of the length of the contact curves, relative to the larger length", 1},
    {Metric::area, "area", "error of the contact area, relative to the larger area", 1},
    {Metric::centroid, "centroid", "distance of the contacts' centroids, relative to the diagonal", 1},
    {Metric::normal, "normal", "angle between the normals of the largest contact, relative to 180 degrees",
     1},
    {Metric::depth, "depth", "error of the largest estimated depth, relative to the diagonal", 1},
    {Metric::distance, "distance",
     "error of the distance, of near pairs the largest one, relative to the larger body's diagonal", 1},
    {Metric::time_of_impact, "time",
     "error of the time of first contact, as a fraction of the motion; 1: a false or a missed contact", 1},
    {Metric::penetration, "penetration",
     "error of the penetration depth, relative to the larger body's diagonal", 1},
    {Metric::list, "list", "fraction of the listed and the near pairs that are missing or extra", 1},
});
inline constexpr std::size_t kMetrics = kMetricInfos.size();

/// Returns the row of a metric: row static_cast<std::size_t>(m) of the table.
constexpr const MetricInfo& metric_info(Metric m) {
  return kMetricInfos[static_cast<std::size_t>(m)];
}
consteval bool metrics_are_in_enum_order() {
  for (std::size_t i = 0; i < kMetrics; ++i)
    if (static_cast<std::size_t>(kMetricInfos[i].metric) != i) return false;
  return true;
}
static_assert(metrics_are_in_enum_order());
/// The errors of the answer to one query; nullopt if the method does not provide it.
using Errors = std::array<std::optional<double>, kMetrics>;

// Records.

/// The answer in one mode.
struct Reply {
  bool contact = false;
  std::uint64_t count = 0;              ///< number of pairs
  std::uint64_t missed = 0, extra = 0;  ///< compared with the exact list
  double cold_us = 0;  ///< time of the first query, after the processor's caches were flushed
  double hot_us = 0;   ///< minimum time of some repetitions
  std::uint64_t face_tests = 0;
  std::optional<double> error_bound;   ///< as in methods::Answer; of a number: width of its interval
  std::optional<double> lower, upper;  ///< the number, if that is the quantity; equal: no interval
  friend bool operator==(const Reply&, const Reply&) = default;
};

struct Record {
  std::string set, method;
  std::optional<double> setting;
  std::uint64_t question = 0;
  std::uint64_t round = 0;  ///< of timing; the answer is judged in round 0
  PoseClass pose_class = PoseClass::apart;
  Outcome outcome = Outcome::answered;
  std::string message;  ///< reason if there is no answer
  Reply all, first;
  double build_seconds = 0;  ///< for both bodies
  double bytes = 0;          ///< growth of the heap by both bodies
  /// Errors of the answer with all pairs, if it was judged. Pairs and points themselves are not stored: those
  /// of some meshes at one pose take 100 MB.
  std::optional<Errors> errors;
};

/// Returns the record of a query, without an answer. Throws InputError if there is no such query.
Record blank_record(const DataSet& set, std::uint64_t question, const std::string& method,
                    std::optional<double> setting);

nlohmann::ordered_json to_json(const Record& r);
/// Reads a record. Throws InputError, which describes the error in the value, if it is invalid.
Record record_from(const nlohmann::json& value);
/// Reads a file of records. Returns an empty list if the file does not exist. Skips incomplete lines, which
/// interrupted runs leave.
std::vector<Record> read_records(const std::string& path);

/// Returns the method's name with its setting: "fcl", "spheres 4".
std::string name_of(const Record& r);
std::string name_of(const std::string& method, std::optional<double> setting);

}  // namespace lrb::speed
