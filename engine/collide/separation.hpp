#pragma once

#include <optional>

#include "engine/collide/query_context.hpp"

namespace lrb {

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

}  // namespace lrb
