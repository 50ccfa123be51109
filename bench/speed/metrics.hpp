#pragma once
/// Computes one point from the records for each method, at each setting, on each data set (two bodies at one
/// class of poses).

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/methods/method.hpp"
#include "bench/speed/record.hpp"
#include "engine/lrb/thickness.hpp"
#include <lrbscope/workspace.hpp>

namespace lrb::bench {

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
};

struct MetricInfo {
  Metric metric;
  const char* name;  ///< in files and tables
  const char* what;  ///< with its unit
  double worst;
};
inline constexpr auto kMetricInfos = std::to_array<MetricInfo>({
    {Metric::contact, "contact", "fraction of poses with a false or a missed contact", 1},
    {Metric::precision, "precision", "1 - precision: fraction of the listed pairs that do not intersect", 1},
    {Metric::recall, "recall", "1 - recall: fraction of the intersecting pairs that are not listed", 1},
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
    {Metric::distance, "distance", "error of the distance, relative to the larger body's diagonal", 1},
    {Metric::time_of_impact, "time",
     "error of the time of first contact, as a fraction of the motion; 1: a false or a missed contact", 1},
    {Metric::penetration, "penetration",
     "error of the penetration depth, relative to the larger body's diagonal", 1},
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
/// Returns the metric that the chart shows for a quantity.
Metric chart_metric(Quantity quantity);

/// The errors of the answer to one query; nullopt if the method does not provide it.
using Errors = std::array<std::optional<double>, kMetrics>;

struct Point {
  std::string set, method;
  std::optional<double> setting;
  PoseClass pose_class = PoseClass::apart;
  std::size_t questions = 0, rejected = 0, crashed = 0, timed_out = 0;
  Errors errors;  ///< means over the queries
  /// Mean proven bound: of Metric::deviation, or, for a number, the width of its interval in the unit of its
  /// error. nullopt: not proven.
  std::optional<double> proven_deviation;
  double median = 0, p95 = 0, p99 = 0;  ///< microseconds, hot, all pairs, over the answered queries
  double build_seconds = 0, bytes = 0;  ///< of both bodies
  double face_tests = 0;                ///< mean; 0: not counted
  std::uint64_t worst_question = 0;     ///< the one with the largest error
  bool frontier = false;                ///< not dominated by another point of its data set

  std::size_t failed() const { return rejected + crashed + timed_out; }
  /// Returns the error on the chart's axis: of the number or the contact region if the method provides one,
  /// else of its boolean answer.
  double error() const;
  bool says_only_yes_or_no() const;
};

using MetricProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Returns the points of all methods on all data sets, with their Pareto frontiers over time and error.
std::vector<Point> measure_points(const std::vector<DataSet>& sets,
                                  const std::vector<methods::MethodInfo>& methods,
                                  const std::vector<Record>& records, const MetricProgress& progress = {});

/// Returns them as JSON, one per line.
std::string to_lines(const std::vector<Point>& points);

/// Returns the quantile of the values at `share` (nearest rank), or 0 if there are no values.
inline double quantile(std::vector<double> x, double share) {
  if (x.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(x.size())));
  const std::size_t i = std::min(x.size() - 1, rank == 0 ? 0 : rank - 1);
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(i), x.end());
  return x[i];
}
inline double median(const std::vector<double>& x) {
  return quantile(x, 0.5);
}
/// Returns the geometric mean of positive values, or 0 if there are no values.
inline double geometric_mean(const std::vector<double>& x) {
  if (x.empty()) return 0;
  double sum = 0;
  for (const double v : x) sum += std::log(v);
  return std::exp(sum / static_cast<double>(x.size()));
}

// Measures the distance between the contact region that a method reports, as a list of pairs or as points,
// and the exact one of the two posed bodies.

/// A contact as a few numbers and many points; all in the world frame and the meshes' unit.
struct Region {
  std::vector<Eigen::Vector3d> points;  ///< corners of the intersections, at most kMaxPoints of them
  double length = 0, area = 0;          ///< sums over connected regions
  Eigen::Vector3d centroid{0, 0, 0};    ///< of the points
  Eigen::Vector3d normal{0, 0, 0};      ///< of the largest connected region; zero if undefined
  double depth = 0;                     ///< the largest
};

/// Errors relative to the diagonal of the larger body, or to the exact value. 1 is the worst of each.
struct RegionError {
  double hausdorff = 0, centroid = 0;  ///< over the diagonal
  double length = 0, area = 0;         ///< over the larger of both values
  double normal = 0;                   ///< angle over 180 degrees
  double depth = 0;                    ///< over the diagonal
};

/// Computes the regions of lists of pairs of two bodies at given poses.
class RegionMaker {
 public:
  /// Keeps references to the bodies.
  RegionMaker(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
  /// Computes the region of these pairs. Pairs that do not intersect contribute only to the points, by the
  /// centroids of their triangles.
  Region of_pairs(const std::vector<SimplexPair>& pairs);

 private:
  const LrbRep &a_, &b_;
  Pose pose_a_, pose_b_;
  Workspace workspace_;
};

/// Measures the distance of world points from two posed bodies.
class BodyDistance {
 public:
  BodyDistance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
  BodyDistance(const BodyDistance&) = delete;  // its members refer to each other
  BodyDistance& operator=(const BodyDistance&) = delete;
  /// Returns the maximum over the points of the sum of the distances from both surfaces, or 0 without points.
  double off(const std::vector<Eigen::Vector3d>& points);

 private:
  struct Side {
    Side(const LrbRep& rep, const Pose& pose);
    double distance(const Eigen::Vector3d& world);
    double unit;
    Pose pose;
    std::vector<Eigen::Vector3d> vertices;  ///< in units
    NearestFace nearest;
  };
  Side a_, b_;
};

Region of_points(const std::vector<Eigen::Vector3d>& points);

/// Returns the errors. Two empty regions have no error; if only one is empty, all errors are the worst.
RegionError region_error(const Region& exact, const Region& found, double diagonal);

}  // namespace lrb::bench
