#pragma once
/// Where a collapsed edge's new vertex goes: the nearest point of a polyhedron.

#include <optional>
#include <span>

#include <Eigen/Core>

namespace lrb::construct {

/// The points x with n.x >= d; n has length 1.
struct HalfSpace {
  Eigen::Vector3d n;
  double d;
};

/// The point of the intersection of half-spaces nearest to `target`, or none if they have no point in common,
/// as far as floating point can tell: half-spaces are kept to within `slack` (unit of the coordinates).
///
/// Incremental, after Seidel (1991): half-spaces come one by one; as long as the nearest point so far is in
/// the next one it stays, else the new one lies in that one's plane, where the same is asked in 2D of those
/// before, and there in turn in 1D. Linear in their number if they come in random order, at worst cubic.
std::optional<Eigen::Vector3d> nearest_point(const Eigen::Vector3d& target,
                                             std::span<const HalfSpace> half_spaces, double slack);

}  // namespace lrb::construct
