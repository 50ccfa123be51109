#pragma once
/// Computes from records one point for each method, at each setting, on each data set (two bodies at one
/// class of poses).

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/rivals/method.hpp"
#include "bench/speed/record.hpp"
#include "engine/lrb/thickness.hpp"
#include <lrbscope/workspace.hpp>

namespace lrb::bench {

/// A way to be wrong, from 0 (not at all) to its worst value, which a question without an answer scores.
enum class Metric : std::uint8_t {
  contact,    ///< says contact where there is none, or the reverse
  precision,  ///< share of the pairs found that do not meet (1 - precision)
  recall,     ///< share of the pairs that meet and were not found (1 - recall)
  hausdorff,  ///< distance of the contact regions
  deviation,  ///< distance of the answer's points from both bodies
  length,
  area,
  centroid,
  normal,
  depth,
  distance,        ///< error of the distance, where a method is asked for that number
  time_of_impact,  ///< error of the time of first contact, where a method is asked for it
  penetration,     ///< error of the penetration depth, where a method is asked for it
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

/// Returns the line of a metric. Number `i` of the table is that of static_cast<Metric>(i).
constexpr const MetricInfo& metric_info(Metric m) {
  return kMetricInfos[static_cast<std::size_t>(m)];
}
consteval bool metrics_are_in_enum_order() {
  for (std::size_t i = 0; i < kMetrics; ++i)
    if (static_cast<std::size_t>(kMetricInfos[i].metric) != i) return false;
  return true;
}
static_assert(metrics_are_in_enum_order());
/// Returns how wrong an answer is where this is asked for: the error that the chart shows.
Metric chart_metric(Quantity quantity);

/// The errors of the answer to one question; nothing where a method does not answer that.
using Errors = std::array<std::optional<double>, kMetrics>;

struct Point {
  std::string set, method;
  std::optional<double> setting;
  PoseClass pose_class = PoseClass::apart;
  std::size_t questions = 0, refused = 0, crashed = 0, timed_out = 0;
  Errors errors;  ///< means over the questions
  /// What is proved, mean: Metric::deviation is no more; or where a number was asked for, its interval is as
  /// wide, in the unit of its error. Nothing: not proved.
  std::optional<double> proved_off;
  double median = 0, p95 = 0, p99 = 0;  ///< microseconds, hot, all pairs, over the questions that were
                                        ///< answered
  double build_seconds = 0, bytes = 0;  ///< of both bodies
  double face_tests = 0;                ///< mean; 0: not counted
  std::uint64_t worst_question = 0;     ///< the one with the largest error
  bool frontier = false;                ///< no other point of its data set is both faster and less wrong

  std::size_t failed() const { return refused + crashed + timed_out; }
  /// Returns the error that the chart shows: that of the number or the contact region if the method gives
  /// one, else that of its yes or no.
  double error() const;
  bool says_only_yes_or_no() const;
};

using MetricProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Returns the points of all methods on all data sets, with their Pareto frontiers over time and error.
std::vector<Point> measure_points(const std::vector<DataSet>& sets,
                                  const std::vector<methods::MethodInfo>& methods,
                                  const std::vector<Record>& records, const MetricProgress& progress = {});

/// Returns them as JSON, one on each line.
std::string to_lines(const std::vector<Point>& points);

/// Returns the value below which a share of the others lies (nearest rank); 0 if there are none.
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
/// Returns the geometric mean of positive values; 0 if there are none.
inline double geometric_mean(const std::vector<double>& x) {
  if (x.empty()) return 0;
  double sum = 0;
  for (const double v : x) sum += std::log(v);
  return std::exp(sum / static_cast<double>(x.size()));
}

// Measures the distance between the contact region that a method reports, by a list of pairs or by points,
// and the exact one of the two posed bodies.

/// A contact in few numbers and many points; all in the world frame and the meshes' unit.
struct Region {
  std::vector<Eigen::Vector3d> points;  ///< corners of the intersections, at most kMostPoints of them
  double length = 0, area = 0;          ///< sums over connected regions
  Eigen::Vector3d centroid{0, 0, 0};    ///< of the points
  Eigen::Vector3d normal{0, 0, 0};      ///< of the largest connected region; zero: none
  double depth = 0;                     ///< the largest
};

/// Errors relative to the diagonal of the larger body, or to the exact value. 1 is the worst of each.
struct RegionError {
  double hausdorff = 0, centroid = 0;  ///< over the diagonal
  double length = 0, area = 0;         ///< over the larger of both values
  double normal = 0;                   ///< angle over 180 degrees
  double depth = 0;                    ///< over the diagonal
};

/// Describes lists of pairs of two bodies at given poses.
class RegionMaker {
 public:
  /// Keeps references to the bodies.
  RegionMaker(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
  /// Describes the region of these pairs. Pairs that do not meet count only for the points, where the middles
  /// of their triangles stand for them.
  Region of_pairs(const std::vector<SimplexPair>& pairs);

 private:
  const LrbRep &a_, &b_;
  Pose pose_a_, pose_b_;
  Workspace workspace_;
};

/// Tells how far points in the world are off two posed bodies.
class BodyDistance {
 public:
  BodyDistance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
  BodyDistance(const BodyDistance&) = delete;  // its parts refer to each other
  BodyDistance& operator=(const BodyDistance&) = delete;
  /// Returns the largest sum of the distances from the one body's surface and from the other's; 0 without
  /// points.
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

/// Returns the errors. Two empty regions have none; if only one is empty, all are the worst.
RegionError region_error(const Region& exact, const Region& found, double diagonal);

}  // namespace lrb::bench
