#pragma once
/// How two bodies lie to each other, once the pairs that meet are known.

#include "engine/exact/locate.hpp"
#include "engine/query/walk/query_context.hpp"

namespace lrb {

enum class Where : std::uint8_t { outside, inside, on_surface };

/// Where a point of the world lies in a closed body, by the parity of an axis-parallel ray: exact, with ties
/// broken symbolically (exact/locate.hpp), so no ray is ever unlucky. Nested and overlapping components count
/// by parity.
Where locate(QueryBody& body, const double* point);
Where locate(QueryBody& body, const exact::RationalPoint& point);

/// Fills in result.relation from result.pairs and, where there are none, from the position of one vertex of
/// each component. Where only some components of a body are swallowed it still counts as inside, since the
/// bodies are then not separate.
void decide_relation(QueryContext& ctx, CollideResult& result);

}  // namespace lrb
