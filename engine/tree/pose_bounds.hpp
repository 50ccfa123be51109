#pragma once
/// What a pose can do to lengths and coordinates: bounds on which culling and proofs in doubles rest.

#include "engine/core/pose.hpp"
#include "engine/tree/obb_tree.hpp"

namespace lrb {

/// How far r^T r is from the identity, largest row sum: a bound of the Euclidean norm, the matrix being
/// symmetric. Not a number where r^T r overflows to what is none.
double rotation_defect(const Eigen::Matrix3d& r);

/// A bound of every world coordinate of a tree's simplices, and of every term on the way to it.
double world_size(const Pose& pose, const ObbTree& tree);

/// The distance that wrappers must keep to prove what is in them apart: see kWrapperMargin.
double wrapper_margin(const Pose& pose_a, const ObbTree& a, const Pose& pose_b, const ObbTree& b);

/// A bound of how much the pose stretches distances; 1 for rotations, but for rounding. For any finite matrix.
double stretch(const Pose& pose);

}  // namespace lrb
