#pragma once
/// One clash query, with buffers that later queries reuse. Internal: users of the installed engine include
/// clash.hpp.

#include <optional>
#include <vector>

#include "engine/clash/unit_bodies.hpp"
#include "engine/distance/distance_context.hpp"
#include <lrbscope/clash.hpp>

namespace lrb {

/// Performs the query of clash() in clash.hpp. probe: null, or notified of bounds.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, DistanceContext& context, ClashProbe* probe = nullptr);

}  // namespace lrb

namespace lrb::penetration {

// Convex sets that are proven to be inside a body.

/// Points whose convex hull is the set; unit coordinates, without rounding. The proof that the set is inside
/// the body: a plane separates every triangle of the body from the set by more than all rounding, so that the
/// surface does not enter the set, and one point of the set is inside.
using ConvexPoints = std::vector<Vector3d>;

/// Returns nearly all of a body that is convex up to rounding, or nullopt if the body is not convex: its
/// points, moved towards `inside` by the least of kShrinks for which the proof succeeds. `inside`: a point
/// that was located inside the body, up to kUnitRounding.
std::optional<ConvexPoints> shrunken_body(const UnitBody& body, const Vector3d& inside);

/// Whether planes may be placed in front of entire triangles if the proof fails with planes in front of the
/// nearest points. The sets are then smaller, and depend on the triangulation.
enum class WholeTriangles : std::uint8_t { no, yes };

/// Returns a large convex set around a point inside, or nullopt if the surface is too near or the proof
/// fails. The set is bounded by planes in front of the nearest points of the surface, added one after the
/// other (as in Deits and Tedrake, "Computing Large Convex Regions of Obstacle-Free Space", 2015, without
/// their ellipsoids).
std::optional<ConvexPoints> convex_about(const UnitBody& body, const Vector3d& inside, WholeTriangles whole);

/// Bounds the penetration depth and the depth along a direction, each if it is requested, of solids whose
/// interiors overlap. Lower bounds come from overlapping sets inside the bodies, upper bounds from
/// translations that are proven to separate. For convex bodies both agree up to rounding. query: begun with
/// the bodies. found: all pairs of intersecting simplices. adapter: null, or notified of bounds on the depth.
void measure_depth(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                   const ClashRequest& request, QueryContext& query, const CollideResult& found,
                   const UnitBodies& bodies, BoundsProbeAdapter* adapter, ClashResult& result);

/// Returns an interval that contains the volume of the intersection of two bodies, in unit lengths cubed. The
/// bodies must be closed and must not intersect themselves.
///
/// Along x a closed surface is a signed sum of prisms: a point is inside if, of the triangles above it, one
/// more faces up than down. So the common volume is the sum over all pairs of triangles, one of each body, of
/// the integral of the lower height over the intersection of their projections, with the product of their
/// orientations as sign. No configuration is degenerate; only rounding has to be bounded.
ProvedInterval shared_volume(const UnitBodies& bodies);

}  // namespace lrb::penetration
