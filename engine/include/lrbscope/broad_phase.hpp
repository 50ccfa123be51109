#pragma once
/// The broad phase: finds the pairs of bodies whose AABBs intersect.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace lrb {

struct BodyPair {
  std::uint32_t i, j;  ///< i < j
  friend auto operator<=>(const BodyPair&, const BodyPair&) = default;
};

/// Sort and sweep (D. Baraff, "Dynamic Simulation of Non-Penetrating Rigid Bodies", 1992, section 2.4.1)
/// along one axis; the other two axes are compared for overlapping pairs. The order of the boxes is kept
/// between steps, so that an insertion sort is cheap if bodies move little. The sweep axis is the one with
/// the lowest density of boxes; it changes only if another has less than half its density.
class SweepAndPrune {
 public:
  /// The cost of the last update.
  struct Work {
    std::uint64_t swaps = 0;      ///< swaps of neighbours in the order
    std::uint64_t box_tests = 0;  ///< pairs that overlap on the axis and were compared on the others
    bool sorted_afresh = false;   ///< true if the number of bodies or the axis changed
  };

  /// Returns the pairs of boxes that intersect (closed sets: touching is enough), ascending. Empty boxes
  /// intersect nothing. Coordinates must not be NaN. Valid until the next update.
  const std::vector<BodyPair>& update(std::span<const Eigen::AlignedBox3d> boxes);
  const Work& work() const { return work_; }

 private:
  void choose_axis(std::span<const Eigen::AlignedBox3d> boxes);
  void sort(std::span<const Eigen::AlignedBox3d> boxes);

  int axis_ = 0;
  std::vector<std::uint32_t> order_;  ///< bodies sorted by the lower end of their boxes on the axis
  std::vector<BodyPair> pairs_;
  Work work_;
};

}  // namespace lrb
