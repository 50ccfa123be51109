#pragma once
/// Computes one point from the records for each method, at each setting, on each data set (two bodies at one
/// class of poses).

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include "bench/speed/data_set.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::speed {

struct Point {
  std::string set, method;
  std::optional<double> setting;
  PoseClass pose_class = PoseClass::apart;
  std::size_t questions = 0, rejected = 0, crashed = 0, timed_out = 0;
  Errors errors;  ///< means over the queries
  /// Mean proven bound: of Metric::deviation, or, for a number, the width of its interval in the unit of its
  /// error. nullopt: not proven.
  std::optional<double> proven_deviation;
  /// Microseconds for all pairs, with warm caches. Of each round the median over the answered queries is
  /// taken; this is the median of these, with their least and largest. 0: no answer.
  double median = 0, least = 0, most = 0;
  double cold = 0, cold_least = 0, cold_most = 0;  ///< the same with cold caches
  double p95 = 0, p99 = 0;                         ///< warm, over the queries of all rounds
  std::size_t rounds = 0;
  double build_seconds = 0, bytes = 0;  ///< of both bodies
  double face_tests = 0;                ///< mean; 0: not counted
  std::uint64_t worst_question = 0;     ///< the one with the largest error
  bool always_wrong = false;            ///< every answer has the worst error, or there is none
  std::string left_out;                 ///< why it cannot be on the frontier; empty: it can
  /// On the frontier: no other point is as accurate and faster beyond the spans of both times, and none as
  /// accurate has a time that overlaps.
  bool frontier = false;
  /// Not on the frontier, but too close to call: names of points as accurate whose times overlap.
  std::vector<std::string> ties;

  std::size_t failed() const { return rejected + crashed + timed_out; }
  /// Returns the error on the chart's axis: of the number or the contact region if the method provides one,
  /// of near pairs the larger of those of the list and of the distances, else of its boolean answer.
  double error() const;
  bool says_only_yes_or_no() const;
};

/// Returns the points of all methods on all data sets, with their Pareto frontiers over time and error.
std::vector<Point> measure_points(const std::vector<DataSet>& sets,
                                  const std::vector<methods::MethodInfo>& methods,
                                  const std::vector<Record>& records);

/// Marks the Pareto frontiers of each data set and class, and points that measured times cannot tell from
/// them.
void mark_frontiers(std::vector<Point>& points, const std::vector<methods::MethodInfo>& methods);

/// Returns the errors of an answer with all pairs, or all near pairs, to a query of a data set; `a` and `b`
/// are its bodies, for near pairs in world coordinates.
Errors errors_of_answer(const DataSet& set, const Question& question, const LrbRep& a, const LrbRep& b,
                        const methods::MethodInfo& info, const methods::Answer& answer);

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

using methods::WorldTriangle;

/// Returns the region of pairs of two bodies at given poses. Pairs that do not intersect contribute only to
/// the points, by the centroids of their triangles.
Region region_of(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                 const std::vector<SimplexPair>& pairs);

/// Returns the maximum over the points of the sum of the distances from both surfaces, or 0 without points.
double deviation(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                 const std::vector<Eigen::Vector3d>& points);

Region of_points(const std::vector<Eigen::Vector3d>& points);

/// Returns the errors. Two empty regions have no error; if only one is empty, all errors are the worst.
RegionError region_error(const Region& exact, const Region& found, double diagonal);

}  // namespace lrb::speed
