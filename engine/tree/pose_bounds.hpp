#pragma once
/// Bounds on what a pose can do to lengths and coordinates, on which culling and proofs in doubles rest.

#include "engine/core/pose.hpp"
#include "engine/tree/obb_tree.hpp"

namespace lrb {

/// Returns how far r^T r is from the identity, as the largest row sum: a bound on the Euclidean norm, because
/// the matrix is symmetric. Returns not-a-number where r^T r overflows to that.
double rotation_defect(const Eigen::Matrix3d& r);

/// Returns a bound on every world coordinate of a tree's simplices, and on every term on the way to it.
double world_size(const Pose& pose, const ObbTree& tree);

/// Returns the distance that wrappers must keep to prove that what is in them is separate: see
/// kWrapperMargin.
double wrapper_margin(const Pose& pose_a, const ObbTree& a, const Pose& pose_b, const ObbTree& b);

/// Returns a bound on how much the pose stretches distances, for any finite matrix; for rotations that is 1,
/// up to rounding.
double stretch(const Pose& pose);

}  // namespace lrb
