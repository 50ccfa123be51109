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
  /// The cost of the last update. Swaps are 0 if it was incremental.
  struct Work {
    std::uint64_t swaps = 0;      ///< swaps of neighbours in the order
    std::uint64_t box_tests = 0;  ///< pairs that overlap on the axis and were compared on the others
    bool sorted_afresh = false;   ///< true if the number of bodies or the axis changed
  };

  /// Returns the pairs of boxes that intersect (closed sets: touching is enough), ascending. Empty boxes
  /// intersect nothing. Coordinates must not be NaN. Valid until the next update.
  const std::vector<BodyPair>& update(std::span<const Eigen::AlignedBox3d> boxes);
  /// The same for boxes of which only those of the bodies `moved` (ascending) differ from the last update:
  /// the pairs of the others are kept and not compared again.
  const std::vector<BodyPair>& update(std::span<const Eigen::AlignedBox3d> boxes,
                                      std::span<const std::uint32_t> moved);
  const Work& work() const { return work_; }

 private:
  using Boxes = std::span<const Eigen::AlignedBox3d>;

  void choose_axis(Boxes boxes);
  void sort(Boxes boxes);
  void sweep(Boxes boxes);
  void sort_by(std::uint32_t BodyPair::*body, std::size_t bodies);
  bool before(Boxes boxes, std::uint32_t i, std::uint32_t j) const;
  void sort_moved(Boxes boxes, std::span<const std::uint32_t> moved);
  void sweep_moved(Boxes boxes, std::uint32_t body);

  int axis_ = 0;
  std::vector<std::uint32_t> order_;  ///< bodies sorted by the lower end of their boxes on the axis
  std::vector<BodyPair> pairs_;
  // The boxes in the order of the sweep, without empty ones, with their ends on the sweep axis and the
  // others.
  std::vector<std::uint32_t> swept_;
  std::vector<double> from_;
  std::vector<float> low_u_, high_u_, low_v_, high_v_;
  std::vector<std::size_t> ends_;  ///< of the pairs of each body, for sorting
  Work work_;
  // For incremental updates.
  double longest_ = 0;               ///< upper bound of the boxes' lengths on the axis
  std::uint64_t moved_ = 0;          ///< bodies moved by incremental updates since the last complete one
  std::vector<bool> has_moved_;      ///< (bodies)
  std::vector<std::uint32_t> rest_;  ///< order_ without moved bodies
  std::vector<BodyPair> found_;      ///< pairs of moved bodies; also a buffer for sorting
};

}  // namespace lrb
