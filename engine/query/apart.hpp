#pragma once

#include "engine/lrb/pose.hpp"
#include "engine/query/block_tree.hpp"

namespace lrb {

/// Proves two simplices (triangles, or segments in the plane) further apart than `margin`: a plane between them
/// keeps that distance from both. False: not proved; within a few margins both answers can come. World
/// coordinates, of which `margin` must be kWrapperMargin of the largest at least.
bool apart_by(double margin, int dim, const double* const a[3], const double* const b[3]);

/// The widest slab found between two simplices, at least what keeps them apart: 0 if there is none, or none
/// wider than `margin`. Looks no further once one is wider than `enough`.
double gap_between(double margin, double enough, int dim, const double* const a[3], const double* const b[3]);

/// For triangles that cross: how far the points of either can move (any displacement of that length, or less,
/// for each) before their edges could cease to pass through the other's interior; 0 if that is not known.
double crossing_depth(const double* const a[3], const double* const b[3]);

/// A bound of every world coordinate of a tree's simplices, and of every term on the way to it.
double world_size(const Pose& pose, const BlockTree& tree);

/// The distance that wrappers must keep to prove what is in them apart: see kWrapperMargin.
double wrapper_margin(const Pose& pose_a, const BlockTree& a, const Pose& pose_b, const BlockTree& b);

/// A bound of how much the pose stretches distances; 1 for rotations, but for rounding.
double stretch(const Pose& pose);

}  // namespace lrb
