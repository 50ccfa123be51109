#pragma once
/// The error measures of an answer.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

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

}  // namespace lrb::bench
