#pragma once
/// Convex sets that are proven to lie inside a body.

#include <optional>
#include <vector>

#include "engine/query/clash/unit_bodies.hpp"

namespace lrb::parting {

/// Points whose convex hull is the set, in units, exactly these doubles. Proof that the set is inside the
/// body: a plane separates every triangle of the body from the set, by more than all rounding, so that the
/// surface does not enter it; and one of its points is inside.
using ConvexPoints = std::vector<Vector3d>;

/// Returns nearly all of a body that is convex up to rounding: its points, moved towards `inside` by the
/// least of kShrinks that can be proven. Returns nullopt if the body is not convex. `inside`: a point that
/// was located inside the body, up to kUnitRounding.
std::optional<ConvexPoints> shrunken_body(const UnitBody& body, const Vector3d& inside);

/// Whether planes may be put in front of whole triangles if planes in front of the nearest points lead to no
/// proof. The sets are smaller then, and depend on the triangulation.
enum class WholeTriangles : std::uint8_t { no, yes };

/// Returns a large convex set around a point inside: planes between it and the nearest points of the surface,
/// one after the other, bound it (as in Deits and Tedrake, "Computing Large Convex Regions of Obstacle-Free
/// Space", 2015, without their ellipsoids). Returns nullopt if the surface is too near or the proof fails.
std::optional<ConvexPoints> convex_about(const UnitBody& body, const Vector3d& inside, WholeTriangles whole);

}  // namespace lrb::parting
