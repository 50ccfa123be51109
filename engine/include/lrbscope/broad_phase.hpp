#pragma once
/// The broad phase: finds which of many bodies can meet at all, as pairs of boxes that do.

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
/// along one axis. Keeps the order of the boxes on it from one step to the next, so that an insertion sort
/// costs little when bodies have moved little; compares the other two axes. Uses the axis on which the boxes
/// are least crowded, and gives it up only for one that is twice as good.
class SweepAndPrune {
 public:
  /// The cost of the last update.
  struct Work {
    std::uint64_t swaps = 0;      ///< swaps of neighbours in the order
    std::uint64_t box_tests = 0;  ///< pairs that overlap on the axis and were compared on the others
    bool sorted_afresh = false;   ///< true if the number of bodies or the axis changed
  };

  /// Returns the pairs of boxes that have a point in common (boxes are closed: touching is enough),
  /// ascending. Empty boxes meet nothing; no coordinate may be NaN. Valid until the next update.
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
