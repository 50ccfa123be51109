#pragma once
/// Finds how two bodies lie to each other, once the pairs that meet are known.

#include "engine/collide/query_context.hpp"
#include "engine/exact/locate.hpp"
#include <lrbscope/observe.hpp>

namespace lrb {

/// Tells where a point of the world lies in a closed body, by the parity of an axis-parallel ray: exact, with
/// ties broken symbolically (exact/locate.hpp), so that no ray is ever degenerate. Nested and overlapping
/// components count by parity.
Where locate(QueryBody& body, const double* point);
Where locate(QueryBody& body, const exact::RationalPoint& point);

/// How many components of a body lie inside the other one.
struct Enclosed {
  std::size_t inside = 0, components = 0;
  bool all() const { return inside == components && components > 0; }
  bool some() const { return inside > 0; }
};

/// Decides the relation where pairs were found, or where inside has no meaning: there only boxes that are
/// apart prove bodies separate. Returns false elsewhere.
bool decide_without_points(QueryContext& ctx, CollideResult& result);
/// Decides the relation of closed bodies whose surfaces do not meet.
void decide_by_enclosure(const Enclosed& a_in_b, const Enclosed& b_in_a, CollideResult& result);

/// Sets result.relation from result.pairs or, if there are none, from the position of one vertex of each
/// component. A body of which only some components are enclosed by the other still counts as inside, because
/// the bodies are then not separate. Returns false, without a relation, if `in_time()`, which is asked before
/// each point is located, does. Calls see(side, vertex, where) for each point.
template <class InTime, class See>
bool decide_relation(QueryContext& ctx, CollideResult& result, InTime&& in_time, See&& see) {
  if (decide_without_points(ctx, result)) return true;
  Enclosed in_other[2];
  for (const Side side : {Side::a, Side::b}) {
    QueryBody &inner = ctx[side], &outer = ctx[other(side)];
    Enclosed& count = in_other[static_cast<int>(side)];
    for (const VertexId v : inner.component_vertices()) {
      if (!in_time()) return false;
      ++count.components;
      const Where where = locate(outer, inner.world(v));
      see(side, v, where);
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
/// Does the same, however long it takes.
void decide_relation(QueryContext& ctx, CollideResult& result);

/// Does the same as a phase of its own, and tells the probe of each point.
template <class Probe, class InTime>
bool decide_relation_watched(QueryContext& ctx, CollideResult& result, Probe& probe, InTime&& in_time) {
  bool decided = false;
  locate_in_phase(probe, [&](const auto& see) { decided = decide_relation(ctx, result, in_time, see); });
  return decided;
}

}  // namespace lrb
