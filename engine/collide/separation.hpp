#pragma once

#include <optional>

#include "engine/collide/query_context.hpp"

namespace lrb {

/// Proves that two simplices (triangles, or segments in the plane) are further apart than `margin`: a plane
/// between them keeps that distance from both. Returns false if that is not proved; within a few margins
/// either answer can come. Takes world coordinates, and `margin` must be at least kWrapperMargin times the
/// largest of them.
bool separated_by(double margin, int dim, const double* const a[3], const double* const b[3]);

/// Returns the certificate for two bodies that are known to be separate. Starts from the outermost wrappers,
/// refines what meets, the larger one of two regions, and at the end takes everything back in that can be.
/// There is none for bodies that are not closed or intersect themselves, or that are nearer than
/// wrapper_margin(): they cannot then be told from what hides them.
std::optional<Separation> find_separation(QueryContext& context);

}  // namespace lrb
