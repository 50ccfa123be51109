#pragma once
/// Pairs of boxes within a distance, by a sweep along one axis.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace lrb::scene {

using Box = Eigen::AlignedBox3d;

/// Returns a lower bound on the distance of two nonempty boxes that deviates from it only by rounding. It is
/// 0 if and only if they intersect.
double gap(const Box& a, const Box& b);

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

/// Returns the axis along which the centres of the boxes spread most.
int longest_axis(std::span<const Box> a, std::span<const Box> b);

/// Calls see(a, b, gap) for each pair of boxes at most `limit` apart; see() may lower the limit.
template <class See>
void each_near_pair(std::span<const Box> boxes, const double& limit, const See& see) {
  const SortedBoxes sorted(boxes, longest_axis(boxes, {}));
  for (std::size_t k = 0; k < sorted.order().size(); ++k)
    for (std::size_t l = k + 1; l < sorted.order().size(); ++l) {
      const std::uint32_t i = sorted.order()[k], j = sorted.order()[l];
      if (sorted.is_beyond(sorted.low(j), i, limit)) break;
      if (const double g = gap(boxes[i], boxes[j]); g <= limit) see(i, j, g);
    }
}

/// The same for pairs of a box of `a` and a box of `b`.
template <class See>
void each_near_pair(std::span<const Box> a, std::span<const Box> b, const double& limit, const See& see) {
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
  sweep(sorted_a, sorted_b, false, see);
  sweep(sorted_b, sorted_a, true, [&](std::uint32_t j, std::uint32_t i, double g) { see(i, j, g); });
}

}  // namespace lrb::scene
