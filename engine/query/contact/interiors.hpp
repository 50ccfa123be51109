#pragma once

#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// Tells whether the interiors of two closed bodies that touch without crossing overlap. Exact where it
/// answers yes or no.
///
/// They overlap if and only if the surface of one has a point strictly inside the other, or the surfaces
/// coincide somewhere facing the same way (if neither holds, each component of one interior lies wholly
/// inside or outside the other; if it lies inside, its boundary does too, up to surfaces that coincide). So:
/// - for coplanar pairs whose intersection has area, the same direction means yes;
/// - a face in no pair lies on one side as a whole, and so does a connected patch of them: one vertex
///   decides;
/// - a face in pairs is cut into cells by its intersections: one exact rational point in each cell decides.
/// Answers unknown for a body that is not closed or intersects itself, and if there are more than
/// kInteriorCells cells.
Answer interiors_overlap(QueryContext& context, const CollideResult& result);

/// Does the same for closed bodies that cross: answers yes, with a proof, or unknown. Faces of a body that
/// rounding has made flat in the world pass through the other's faces too, but nothing lies between them: a
/// crossing counts only where no other face of either body lies. All pairs must be in `result`.
Answer crossing_interiors_overlap(QueryContext& context, const CollideResult& result);

}  // namespace lrb
