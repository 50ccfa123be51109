#pragma once
/// Prepares the dual traversal of two trees: both bodies' poses as one motion of B in A's frame, and a bound
/// of all errors that come with it.

#include <algorithm>

#include "engine/core/pose.hpp"
#include "engine/tree/tree_kernel.hpp"

namespace lrb {

/// Returns the unit in which two trees are compared, as a multiple of the meshes' unit.
inline double query_unit(const ObbTree& a, const ObbTree& b) {
  return std::max(a.unit(), b.unit());
}

/// Returns a kernel with everything filled in but its buffers (stack and out).
TreeKernel set_up_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b);

}  // namespace lrb
