#pragma once
/// Results of a query beyond the intersecting pairs: the relation of the bodies, a certificate of separation,
/// and a description of the contact.

#include <optional>

#include "engine/collide/query_context.hpp"
#include "engine/exact/locate.hpp"
#include <lrbscope/observe.hpp>

namespace lrb {

/// Returns the location of a world point relative to a closed body, by the parity of ray crossings. Exact:
/// ties are broken symbolically (exact/locate.hpp), so that no ray is degenerate. Nested and overlapping
/// components count by parity.
Where locate(QueryBody& body, const double* point);
Where locate(QueryBody& body, const exact::RationalPoint& point);

/// Returns whether a closed body has interior points near a point of its surface; exact. Around the point its
/// faces must lie in one plane, and the point must be inside each of them: nullopt otherwise. False beside
/// faces that cancel each other, such as both sides of a plate without thickness.
std::optional<bool> has_solid_beside(QueryBody& body, const exact::RationalPoint& point);

/// Number of components of a body inside the other body.
struct Enclosed {
  std::size_t inside = 0, components = 0;
  bool all() const { return inside == components && components > 0; }
  bool some() const { return inside > 0; }
};

/// Decides the relation if pairs were found or if a body is not closed. A body that is not closed has no
/// inside: only disjoint boxes prove it separate. Returns false if neither applies.
bool decide_without_points(QueryContext& ctx, CollideResult& result);
/// Sets the relation of closed bodies that are proven to be disjoint.
inline void set_separate(CollideResult& result) {
  result.relation = Relation::separate;
  result.interiors_overlap = Answer::no;
}
/// Decides the relation of closed bodies whose surfaces do not intersect.
void decide_by_enclosure(const Enclosed& a_in_b, const Enclosed& b_in_a, CollideResult& result);

/// Sets result.relation from result.pairs or, if there are no pairs, from the location of one vertex of each
/// component. A body counts as inside the other even if only some of its components are enclosed, because the
/// bodies are then not separate. `in_time()` is called before each point location; once it returns false,
/// this returns false and sets no relation. Calls visit(side, vertex, where) for each point.
template <class InTime, class Visit>
bool decide_relation(QueryContext& ctx, CollideResult& result, InTime&& in_time, Visit&& visit) {
  if (decide_without_points(ctx, result)) return true;
  Enclosed in_other[2];
  for (const Side side : {Side::a, Side::b}) {
    QueryBody &inner = ctx[side], &outer = ctx[other(side)];
    Enclosed& count = in_other[static_cast<int>(side)];
    for (const VertexId v : inner.component_vertices()) {
      if (!in_time()) return false;
      ++count.components;
      const Where where = locate(outer, inner.world(v));
      visit(side, v, where);
      count.inside += where == Where::inside;
    }
  }
  decide_by_enclosure(in_other[0], in_other[1], result);
  return true;
}

template <class InTime>
bool decide_relation(QueryContext& ctx, CollideResult& result, InTime&& in_time) {
  return decide_relation(ctx, result, in_time, [](Side, VertexId, Where) {});
}
/// Decides the relation without a time limit.
void decide_relation(QueryContext& ctx, CollideResult& result);

/// Decides the relation as a phase of its own, and reports each located point to the probe.
template <class Probe, class InTime>
bool decide_relation_watched(QueryContext& ctx, CollideResult& result, Probe& probe, InTime&& in_time) {
  bool decided = false;
  locate_in_phase(probe, [&](const auto& visit) { decided = decide_relation(ctx, result, in_time, visit); });
  return decided;
}

/// Returns true if two simplices (triangles, or segments in 2D) are proven to be further apart than `margin`:
/// a slab of that width separates them. Returns false if no proof is found; at distances within a few margins
/// either result is possible. Takes world coordinates. `margin` must be at least kWrapperMargin times the
/// largest of them.
bool separated_by(double margin, int dim, const double* const a[3], const double* const b[3]);

/// Returns the certificate for two bodies that are known to be separate, or nullopt if a body is not closed
/// or intersects itself, or if the bodies are nearer than wrapper_margin(), because refined wrappers cannot
/// then be proven disjoint. Starts from the outermost wrappers, refines the larger region wherever two faces
/// intersect, and at the end coarsens every region that the proof does not need.
std::optional<Separation> find_separation(QueryContext& context);

/// Sets interiors_overlap, contacts and regions of a result, as far as requested.
void describe_contact(QueryContext& context, const CollideRequest& request, CollideResult& result);

}  // namespace lrb
