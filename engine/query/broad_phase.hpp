#pragma once
/// Which of many bodies can meet at all: pairs of boxes that do.

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
/// along one axis. The order of the boxes on it is kept from one step to the next, where an insertion sort of
/// what has moved a little costs little; the other two axes are compared. The axis is the one on which the
/// boxes are fewest to a place, and is given up only for one that is twice as good.
class SweepAndPrune {
 public:
  /// What the last update cost.
  struct Work {
    std::uint64_t swaps = 0;      ///< of neighbours in the order
    std::uint64_t box_tests = 0;  ///< pairs that meet on the axis, compared on the others
    bool sorted_afresh = false;   ///< the number of bodies or the axis changed
  };

  /// The pairs of boxes that have a point in common (they are closed: touching is enough), ascending. Empty
  /// boxes meet nothing; no coordinate may be NaN. Valid until the next update.
  const std::vector<BodyPair>& update(std::span<const Eigen::AlignedBox3d> boxes);
  const Work& work() const { return work_; }

 private:
  void choose_axis(std::span<const Eigen::AlignedBox3d> boxes);
  void sort(std::span<const Eigen::AlignedBox3d> boxes);

  int axis_ = 0;
  std::vector<std::uint32_t> order_;  ///< bodies by the lower end of their boxes on the axis
  std::vector<BodyPair> pairs_;
  Work work_;
};

}  // namespace lrb
