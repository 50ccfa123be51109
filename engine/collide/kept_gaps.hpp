#pragma once
/// Gaps between faces that the incremental form of the paper's recursion keeps from step to step: for pairs
/// that were tested and do not intersect, a lower bound of their distance. Until B has moved that far
/// relative to A, the pair needs no test.

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <Eigen/Core>

#include "engine/collide/query_context.hpp"
#include "engine/collide/relative_motion.hpp"

namespace lrb {

class KeptGaps {
 public:
  KeptGaps(const LrbRep& a, const LrbRep& b);

  /// Begins a query at the next poses. A relative motion that is not rigid (kRigid) ends all gaps.
  void begin(const Pose& pose_a, const Pose& pose_b);
  void forget() { until_.clear(); }

  /// Returns true if the faces cannot intersect at these poses.
  bool are_apart(FaceId a, FaceId b);
  /// Keeps the gap between two faces that do not intersect at the context's poses.
  void keep(QueryContext& context, FaceId a, FaceId b);
  /// Notes that this query refines a region.
  void reach(Side side, RegionId r) { reached_[static_cast<int>(side)].insert(r); }
  bool is_reached(Side side, RegionId r) const { return reached_[static_cast<int>(side)].contains(r); }

  /// Returns the number of pairs that this query did not need to test.
  std::uint64_t saved() const { return saved_; }

 private:
  static std::uint64_t key(FaceId a, FaceId b) { return std::uint64_t{a.value()} << 32 | b.value(); }

  double size_[2];                   ///< the largest norm of a vertex of A and of B
  Eigen::Vector3d corners_of_b_[8];  ///< of the box of its vertices, of pseudo faces too
  RelativePose last_;
  bool is_rigid_ = false;
  double moved_ = 0;     ///< upper bound of the way of any point of B on A's axes, over all steps
  double rounding_ = 0;  ///< of lengths at these poses, and the part that is not rigid
  std::unordered_map<std::uint64_t, double>
      until_;  ///< by pair of faces: the value of moved_ up to which they are apart
  std::unordered_set<std::uint32_t> reached_[2];
  std::uint64_t requested_ = 0, saved_ = 0;
};

}  // namespace lrb
