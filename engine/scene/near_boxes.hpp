#pragma once
/// Pairs of AABBs within a distance, by sort and sweep along one axis (Baraff 1992).
/// 1. Choose the axis along which the boxes' centres spread most.
/// 2. Sort the boxes by their lower ends on it.
/// 3. For each box, visit the following ones until they begin beyond its upper end plus the limit.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"

namespace lrb::scene {

using Box = Eigen::AlignedBox3d;

/// Exceeds the relative rounding error of differences, norms and products of a few doubles.
inline constexpr double kRoundedDown = 1 - 0x1p-48;

/// Returns a lower bound on the distance of two nonempty boxes that deviates from it only by rounding. It is
/// 0 if and only if they intersect.
inline double gap(const Box& a, const Box& b) {
  // Per axis, the distance of the intervals, or 0 if they overlap. Zero on all axes: the closed boxes
  // intersect.
  const Eigen::Vector3d gaps = (b.min() - a.max()).cwiseMax(a.min() - b.max()).cwiseMax(0);
  constexpr double kMax = std::numeric_limits<double>::max();
  // Larger gaps count as half the largest double: still a lower bound, and the norm stays finite.
  if (!(gaps.maxCoeff() <= kMax / 2)) return kMax / 2;
  // Rounded down, because callers prune pairs by it.
  return stable_norm3(gaps) * kRoundedDown;
}

/// The nonempty boxes in the order of their lower ends on an axis. The boxes must outlive it.
class SortedBoxes {
 public:
  SortedBoxes(std::span<const Box> boxes, int axis);

  std::span<const Box> boxes() const { return boxes_; }
  const std::vector<std::uint32_t>& order() const { return order_; }
  double low(std::uint32_t box) const { return boxes_[box].min()[axis_]; }
  /// Returns true if every box with a lower end of at least `low` is further than `limit` from this one.
  bool is_beyond(double low, std::uint32_t box, double limit) const;
  /// Returns the index in the order of the first box whose lower end is at least `low` (if `above`: greater
  /// than `low`).
  std::size_t first_from(double low, bool above) const;

 private:
  std::span<const Box> boxes_;
  int axis_;
  std::vector<std::uint32_t> order_;
};

inline SortedBoxes::SortedBoxes(std::span<const Box> boxes, int axis) : boxes_(boxes), axis_(axis) {
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    // Free slots have empty boxes. Ties are broken by index, so the order is unique.
    if (!boxes[i].isEmpty()) order_.push_back(i);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t x, std::uint32_t y) { return low(x) != low(y) ? low(x) < low(y) : x < y; });
}

inline bool SortedBoxes::is_beyond(double low, std::uint32_t box, double limit) const {
  // The same rounding as in gap(): a pair within the limit is never pruned.
  return (low - boxes_[box].max()[axis_]) * kRoundedDown > limit;
}

inline std::size_t SortedBoxes::first_from(double from, bool above) const {
  // Binary search. `above` skips equal lower ends, which makes one of two sweeps half-open.
  const auto found = std::partition_point(
      order_.begin(), order_.end(), [&](std::uint32_t i) { return above ? low(i) <= from : low(i) < from; });
  return static_cast<std::size_t>(found - order_.begin());
}

/// Returns the axis along which the centres of the boxes spread most.
inline int longest_axis(std::span<const Box> a, std::span<const Box> b) {
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

/// Calls visit(a, b, gap) for each pair of boxes at most `limit` apart; visit() may lower the limit.
template <class Visit>
void each_near_pair(std::span<const Box> boxes, const double& limit, const Visit& visit) {
  const SortedBoxes sorted(boxes, longest_axis(boxes, {}));
  for (std::size_t k = 0; k < sorted.order().size(); ++k)
    for (std::size_t l = k + 1; l < sorted.order().size(); ++l) {
      const std::uint32_t i = sorted.order()[k], j = sorted.order()[l];
      if (sorted.is_beyond(sorted.low(j), i, limit)) break;
      if (const double g = gap(boxes[i], boxes[j]); g <= limit) visit(i, j, g);
    }
}

/// The same for pairs of a box of `a` and a box of `b`.
template <class Visit>
void each_near_pair(std::span<const Box> a, std::span<const Box> b, const double& limit, const Visit& visit) {
  const int axis = longest_axis(a, b);
  const SortedBoxes sorted_a(a, axis), sorted_b(b, axis);
  // Each pair once: if two boxes begin at the same coordinate, the one of A counts as the first.
  const auto sweep = [&](const SortedBoxes& firsts, const SortedBoxes& seconds, bool above,
                         const auto& found) {
    for (const std::uint32_t i : firsts.order())
      for (std::size_t k = seconds.first_from(firsts.low(i), above); k < seconds.order().size(); ++k) {
        const std::uint32_t j = seconds.order()[k];
        if (firsts.is_beyond(seconds.low(j), i, limit)) break;
        if (const double g = gap(firsts.boxes()[i], seconds.boxes()[j]); g <= limit) found(i, j, g);
      }
  };
  sweep(sorted_a, sorted_b, false, visit);
  sweep(sorted_b, sorted_a, true, [&](std::uint32_t j, std::uint32_t i, double g) { visit(i, j, g); });
}

}  // namespace lrb::scene
