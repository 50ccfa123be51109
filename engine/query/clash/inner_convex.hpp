#pragma once
/// Convex sets that are proved to lie inside a body.

#include <optional>
#include <vector>

#include "engine/query/clash/unit_bodies.hpp"

namespace lrb::parting {

/// Corners of a convex set in the unit's coordinates, exactly these doubles. Proof that the set lies in the
/// body: every triangle of the body lies beyond a plane that has the set on its other side, by more than all
/// rounding, so that the surface does not enter it; and one of its points lies inside.
using ConvexPoints = std::vector<Vector3d>;

/// Returns nearly all of a body that is convex but for rounding: its points, moved towards `inside` by a
/// 2^-40th or as little as can be proved. None if it is not convex. `inside`: a point that was found inside
/// the body, but for kUnitRounding.
std::optional<ConvexPoints> shrunken_body(const UnitBody& body, const Vector3d& inside);

/// Whether planes may be put before whole triangles where planes before the nearest points lead to no proof.
/// The sets are smaller then, and depend on how the surface is divided.
enum class WholeTriangles : std::uint8_t { no, yes };

/// Returns a large convex set about a point inside: planes between it and the nearest points of the surface,
/// one after the other, bound it (as in Deits and Tedrake, "Computing Large Convex Regions of Obstacle-Free
/// Space", 2015, without their ellipsoids). None if the surface is too near for proofs, or none was found.
std::optional<ConvexPoints> convex_about(const UnitBody& body, const Vector3d& inside, WholeTriangles whole);

}  // namespace lrb::parting
