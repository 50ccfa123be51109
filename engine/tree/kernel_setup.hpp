#pragma once
/// Prepares the dual traversal of two trees: both bodies' poses as one motion of B in A's frame, and a bound
/// on all errors that come with it.

#include <algorithm>
#include <vector>

#include "engine/core/pose.hpp"
#include "engine/tree/tree_kernel.hpp"

namespace lrb {

/// Returns the unit in which two trees are compared, as a multiple of the meshes' unit.
inline double query_unit(const ObbTree& a, const ObbTree& b) {
  return std::max(a.unit(), b.unit());
}

/// Returns a kernel with everything filled in but its buffers (stacks and out). Meant for poses that are
/// nearly rotations; for others it is right, too, but culls little.
TreeKernel set_up_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b);

/// Returns the same for any poses. What it needs for poses that are not rotations is put into `terms`, which
/// must live as long as the kernel. dim: that of both bodies.
TreeKernel set_up_any_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b,
                             int dim, AffineTerms& terms);

/// Puts the pair of roots on the kernel's stacks, which are in `room`; that grows if it has to.
void start_at_roots(TreeKernel& k, const ObbTree& a, const ObbTree& b, std::vector<NodePair>& room);

/// Makes the kernel of two wrappers allow for what rounding does to the bodies in them, too: see
/// kWrapperSlack.
void allow_for_wrappers(TreeKernel& k);

}  // namespace lrb
