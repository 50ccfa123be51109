#pragma once
/// Planes that separate pairs of nodes, kept from step to step of a motion.

#include <cstddef>
#include <vector>

#include "engine/distance/distance_kernel.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

class FarPairs {
 public:
  /// Passes the cache to the kernel for one step. k.tree: of the same trees at each step. node_pairs: the
  /// number of pairs of nodes of both trees.
  void lend(DistanceKernel& k, std::size_t node_pairs);

 private:
  std::vector<FarNodes> nodes_;
  double m_[3][4] = {};  ///< TreeKernel::m of the last step; 0 before the first, a large change
  double turned_ = 0;    ///< sum of the norms of its changes since planes were last cleared
};

// Bounds the approach of two bodies from one step of a motion to the next.

/// The poses of two bodies.
struct PosePair {
  Pose a, b;
};

/// Returns an upper bound on the decrease of the distance between any point of A and any point of B from
/// `from` to `to`, for points at most `reach` apart at `from`, or infinity if a pose is not a rotation or B
/// becomes mirrored. The bound also holds for all poses in between if the motion of B relative to A is
/// interpolated at constant velocity.
double nearer_by(const LrbRep& a, const LrbRep& b, const PosePair& from, const PosePair& to, double reach);

}  // namespace lrb
