#pragma once

#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// Do the interiors of two closed bodies that touch without crossing overlap? Exact where it answers yes or
/// no.
///
/// They overlap if and only if the surface of one has a point strictly inside the other, or the surfaces
/// coincide somewhere facing the same way (if neither holds, each component of one interior lies wholly
/// inside or outside the other; if it lies inside, its boundary does too, up to surfaces that coincide). So:
/// - coplanar pairs whose intersection has area: same direction, yes;
/// - a face in no pair lies on one side as a whole, and so does a connected patch of them: one vertex
/// decides;
/// - a face in pairs is cut into cells by its intersections: one exact rational point in each cell decides.
/// Unknown: a body that is not closed or intersects itself, or more cells than kInteriorCells.
Answer interiors_overlap(QueryContext& context, const CollideResult& result);

/// The same for closed bodies that cross: yes, with a proof, or unknown. Faces of a body that rounding has
/// made flat in the world pass through the other's faces too, but nothing lies between them: a crossing
/// counts only where no other face of either body lies. All pairs must be in `result`.
Answer crossing_interiors_overlap(QueryContext& context, const CollideResult& result);

}  // namespace lrb
