#pragma once
/// One clash query, with memory that later queries reuse. Internal: users of the installed engine include
/// clash.hpp.

#include <optional>
#include <vector>

#include "engine/clash/unit_bodies.hpp"
#include "engine/distance/distance_context.hpp"
#include <lrbscope/clash.hpp>

namespace lrb {

/// Answers as clash() in clash.hpp does. probe: null, or notified of bounds.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, DistanceContext& context, ClashProbe* probe = nullptr);

}  // namespace lrb

namespace lrb::parting {

// Convex sets that are proven to lie inside a body.

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

// The volume of the intersection of two closed bodies.

/// Returns an interval that contains the volume, in units cubed. The bodies must be closed and must not
/// intersect themselves.
///
/// Along x a closed surface is a signed sum of prisms: a point is inside if one more of the triangles above
/// it faces up than down. So the common volume is the sum over pairs of triangles, one of each body, of the
/// integral of the lower height over the intersection of their projections, with the product of their
/// orientations as sign. No configuration is degenerate; there is only rounding.
ProvedInterval shared_volume(const UnitBodies& bodies);

}  // namespace lrb::parting
