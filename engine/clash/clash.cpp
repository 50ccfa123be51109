/// The clash query: the kind of contact of two solids, and how deep it is. Steps:
/// 1. Find all intersecting pairs of triangles with the exact query.
/// 2. Disjoint solids: measure the distance, and compare it with the clearance.
/// 3. Otherwise cut each surface by the other and count the pieces inside and outside (surface_pieces.hpp):
///    they decide whether interiors overlap, and the kind.
/// 4. If interiors overlap, bound the penetration depth (depth.cpp) and the common volume
///    (shared_volume.cpp).

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/clash/clash_parts.hpp"
#include "engine/clash/surface_pieces.hpp"
#include "engine/collide/collide_into.hpp"
#include "engine/collide/interiors.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

/// Forwards bounds to a function of a probe, which may be null if no bounds are reported.
struct ClashProbeAdapter final : BoundsProbe {
  using Report = void (ClashProbe::*)(const Bounds&);
  ClashProbeAdapter(ClashProbe* p, Report function) : probe(p), report(function) {}
  void bounds(const Bounds& known) override { (probe->*report)(known); }
  ClashProbe* probe;
  Report report;
};

/// Returns the kind of contact of bodies whose interiors are disjoint but whose surfaces intersect: the
/// highest dimension of a pair's intersection.
ClashKind touching_kind(QueryContext& query, const CollideResult& found) {
  int most = 1;
  for (const SimplexPair& pair : found.pairs) {
    const double *a[3], *b[3];
    query[Side::a].world.corners(pair.a, a);
    query[Side::b].world.corners(pair.b, b);
    // Corners of the pair's intersection: 1 a point, 2 a segment, 3 or more an area.
    most = std::max(most, std::min<int>(exact::contact_of_triangles(a, b).corner_count, 3));
  }
  return most == 3   ? ClashKind::touching_face
         : most == 2 ? ClashKind::touching_edge
                     : ClashKind::touching_point;
}

/// Returns the kind of contact of bodies whose interiors overlap. One body contains the other if no piece of
/// the other's surface is outside it, and no piece of its own surface is inside the other (a cavity) or
/// coincides with the other's surface with opposite orientation (a cavity that the other fills).
ClashKind overlapping_kind(const std::array<SurfacePieces, 2>& pieces) {
  const SurfacePieces &a = pieces[0], &b = pieces[1];
  const bool a_in_b = a.outside == 0 && b.inside == 0 && !a.on_opposite;
  const bool b_in_a = b.outside == 0 && a.inside == 0 && !a.on_opposite;
  // Containment in both directions: the same solid.
  if (a_in_b) return b_in_a ? ClashKind::equal : ClashKind::a_inside_b;
  if (b_in_a) return ClashKind::b_inside_a;
  // Several pieces outside on one component: the other body passes through it.
  if (b.max_outside > 1) return ClashKind::cuts_through;
  return a.max_outside > 1 ? ClashKind::pierces : ClashKind::protrudes;
}

/// Measures the distance of disjoint solids, and compares it with the clearance.
void measure_gap(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                 const ClashRequest& request, DistanceContext& context, ClashProbe* probe,
                 ClashResult& result) {
  DistanceRequest ask;
  ask.relation = false;
  ClashProbeAdapter adapter(probe, &ClashProbe::distance);
  const DistanceResult d =
      distance(a, pose_a, b, pose_b, ask, context, nullptr, probe != nullptr ? &adapter : nullptr);
  result.distance = {d.lower, d.upper};
  bool within = d.upper <= request.clearance;
  // The interval contains the clearance: compare exactly. This request ends when that comparison is decided.
  if (!within && d.lower <= request.clearance) {
    ask.within = request.clearance;
    within = distance(a, pose_a, b, pose_b, ask, context).within.value_or(false);
  }
  result.kind = within ? ClashKind::within_clearance : ClashKind::apart;
}

/// Decides the kind of contact of bodies that share a point.
void decide_kind(QueryContext& query, const CollideResult& found, ClashResult& result) {
  // Exact. Fails, with a reason, for bodies that are not solids and for faces cut into too many cells.
  const bool is_proven =
      found.relation == Relation::crossing && crossing_interiors_overlap(query, found) == Answer::yes;
  bool solid_inside = true;
  const auto pieces = surface_pieces(query, found, result.reason, is_proven ? nullptr : &solid_inside);
  if (!pieces) return;
  result.pieces = *pieces;
  const bool enters = (*pieces)[0].inside + (*pieces)[1].inside > 0;
  // A piece of one surface inside the other solid proves overlap, if it is not of a flap without thickness.
  if (is_proven || (enters && solid_inside))
    result.interiors_overlap = Answer::yes;
  else if (enters)
    result.interiors_overlap = (*pieces)[0].on_same ? Answer::unknown : Answer::no;
  else
    // Otherwise interiors overlap only if surfaces coincide with both solids on the same side.
    result.interiors_overlap = (*pieces)[0].on_same ? interiors_overlap(query, found) : Answer::no;
  result.shares_faces = (*pieces)[0].on_same && result.interiors_overlap == Answer::yes;
  if (result.interiors_overlap == Answer::yes) result.kind = overlapping_kind(*pieces);
  if (result.interiors_overlap == Answer::no) result.kind = touching_kind(query, found);
  if (result.interiors_overlap == Answer::unknown) result.reason = ClashReason::faces_coincide;
}

double to_world_cube(double volume, int exponent) {
  // In three steps: 2^(3 exponent) may be out of range even if the product is not.
  return std::ldexp(std::ldexp(std::ldexp(volume, exponent), exponent), exponent);
}

/// Returns a volume in world units. Values outside the range of normal doubles are rounded outward.
ProvedInterval world_volume(const ProvedInterval& unit, int exponent) {
  constexpr double kLeast = std::numeric_limits<double>::min(), kMax = std::numeric_limits<double>::max();
  ProvedInterval v{to_world_cube(unit.lower, exponent), to_world_cube(unit.upper, exponent)};
  // Below the normal range the scaling was rounded: widen the interval to 0 and to the least normal double.
  if (v.lower < kLeast) v.lower = 0;
  v.lower = std::min(v.lower, kMax);
  if (unit.upper > 0) v.upper = std::max(v.upper, kLeast);
  return v;
}

/// Bounds the penetration depth, the depth along a direction, and the common volume.
void measure_overlap(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const ClashRequest& request, QueryContext& query, const CollideResult& found,
                     ClashProbe* probe, ClashResult& result) {
  // In one common frame, in which no coordinate exceeds 1/2.
  const UnitBodies bodies = unit_bodies(query);
  if (request.depth || request.along) {
    ClashProbeAdapter on_depth(probe, &ClashProbe::depth);
    BoundsProbeAdapter adapter(on_depth);
    measure_depth(a, pose_a, b, pose_b, request, query, found, bodies, probe != nullptr ? &adapter : nullptr,
                  result);
  }
  // The faces of a body that intersects itself do not bound a single solid.
  if (request.volume && !a.overlaps_itself() && !b.overlaps_itself())
    result.volume = world_volume(shared_volume(bodies), bodies.frame.exponent);
}

void write_no_overlap(const ClashRequest& request, ClashResult& result) {
  if (request.depth) result.depth = ProvedInterval{};
  if (request.along) result.along = ProvedInterval{};
  if (request.volume) result.volume = ProvedInterval{};
}

}  // namespace

const char* to_string(ClashKind k) {
  return name_of(k).data();
}

void check_request(const LrbRep& a, const ClashRequest& request) {
  const FloatMode float_mode;
  if (a.dim() != 3) throw InputError("clash: expected 3D bodies, found 2D bodies");
  if (!(request.clearance >= 0) || std::isinf(request.clearance))
    throw InputError("clash: expected a finite clearance of at least 0, found " +
                     std::to_string(request.clearance));
  if (request.along && (!request.along->allFinite() || request.along->isZero(0)))
    throw InputError("clash: expected a direction of finite length other than 0");
}

ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, DistanceContext& context, ClashProbe* probe) {
  const FloatMode float_mode;
  check_query(a, pose_a, b, pose_b);
  check_request(a, request);
  NullProbe unwatched;
  // Step 1.
  const CollideResult found = collide(a, pose_a, b, pose_b, {}, context.query, unwatched);
  ClashResult result;
  const bool solids = a.closed() && b.closed();
  // An open body has no interior: without an intersecting pair the bodies count as disjoint.
  if (found.relation == Relation::separate || (found.pairs.empty() && !solids)) {
    measure_gap(a, pose_a, b, pose_b, request, context, probe, result);
    result.interiors_overlap = found.interiors_overlap;
    // The measures of an overlap are exactly 0.
    if (solids) write_no_overlap(request, result);
    return result;
  }
  // Step 3.
  decide_kind(context.query, found, result);
  if (result.interiors_overlap == Answer::no)
    write_no_overlap(request, result);
  else if (solids)
    // Step 4, also if it is unknown whether interiors overlap.
    measure_overlap(a, pose_a, b, pose_b, request, context.query, found, probe, result);
  return result;
}

ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request) {
  DistanceContext context;
  return clash(a, pose_a, b, pose_b, request, context);
}

ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, ClashProbe& probe) {
  DistanceContext context;
  return clash(a, pose_a, b, pose_b, request, context, &probe);
}

}  // namespace lrb
