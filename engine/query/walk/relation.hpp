#pragma once
/// Finds how two bodies lie to each other, once the pairs that meet are known.

#include "engine/exact/locate.hpp"
#include "engine/query/walk/query_context.hpp"

namespace lrb {

enum class Where : std::uint8_t { outside, inside, on_surface };

/// Tells where a point of the world lies in a closed body, by the parity of an axis-parallel ray: exact, with
/// ties broken symbolically (exact/locate.hpp), so that no ray is ever degenerate. Nested and overlapping
/// components count by parity.
Where locate(QueryBody& body, const double* point);
Where locate(QueryBody& body, const exact::RationalPoint& point);

/// Sets result.relation from result.pairs or, if there are none, from the position of one vertex of each
/// component. A body of which only some components are enclosed by the other still counts as inside, because
/// the bodies are then not separate.
void decide_relation(QueryContext& ctx, CollideResult& result);

}  // namespace lrb
