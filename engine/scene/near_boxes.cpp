// Pairs of AABBs within a distance, by sort and sweep along one axis (Baraff 1992).
// 1. Choose the axis along which the boxes' centres spread most.
// 2. Sort the boxes by their lower ends on it.
// 3. For each box, visit the following ones until they begin beyond its upper end plus the limit.

#include "engine/scene/near_boxes.hpp"

#include <algorithm>
#include <limits>

#include "engine/core/geometry.hpp"

namespace lrb::scene {
namespace {

/// Exceeds the relative rounding error of differences, norms and products of a few doubles.
constexpr double kRoundedDown = 1 - 0x1p-48;

}  // namespace

double gap(const Box& a, const Box& b) {
  // Per axis, the distance of the intervals, or 0 if they overlap. Zero on all axes: the closed boxes
  // intersect.
  const Eigen::Vector3d gaps = (b.min() - a.max()).cwiseMax(a.min() - b.max()).cwiseMax(0);
  constexpr double kMax = std::numeric_limits<double>::max();
  // Larger gaps count as half the largest double: still a lower bound, and the norm stays finite.
  if (!(gaps.maxCoeff() <= kMax / 2)) return kMax / 2;
  // Rounded down, because callers prune pairs by it.
  return stable_norm3(gaps) * kRoundedDown;
}

SortedBoxes::SortedBoxes(std::span<const Box> boxes, int axis) : boxes_(boxes), axis_(axis) {
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    // Free slots have empty boxes. Ties are broken by index, so the order is unique.
    if (!boxes[i].isEmpty()) order_.push_back(i);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t x, std::uint32_t y) { return low(x) != low(y) ? low(x) < low(y) : x < y; });
}

bool SortedBoxes::is_beyond(double low, std::uint32_t box, double limit) const {
  // The same rounding as in gap(): a pair within the limit is never pruned.
  return (low - boxes_[box].max()[axis_]) * kRoundedDown > limit;
}

std::size_t SortedBoxes::first_from(double from, bool above) const {
  // Binary search. `above` skips equal lower ends, which makes one of two sweeps half-open.
  const auto found = std::partition_point(
      order_.begin(), order_.end(), [&](std::uint32_t i) { return above ? low(i) <= from : low(i) < from; });
  return static_cast<std::size_t>(found - order_.begin());
}

int longest_axis(std::span<const Box> a, std::span<const Box> b) {
  Box whole;
  for (const std::span<const Box> boxes : {a, b})
    for (const Box& box : boxes) {
      // Bodies that leave the range of doubles have infinite boxes, which would mask the spread of the
      // others.
      if (!box.isEmpty() && box.min().allFinite() && box.max().allFinite()) whole.extend(box.center());
    }
  if (whole.isEmpty()) return 0;
  int axis = 0;
  // Halved, so that the extent cannot overflow.
  (whole.max() / 2 - whole.min() / 2).maxCoeff(&axis);
  return axis;
}

}  // namespace lrb::scene
