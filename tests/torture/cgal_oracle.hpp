#pragma once

namespace lrb::torture {

/// Returns true if CGAL was found when this was built.
bool has_cgal();

/// Returns whether two triangles intersect according to CGAL's exact predicates: 1 or 0; -1 if unavailable
/// (no CGAL, or a triangle without area, which it does not take).
int cgal_triangles_meet(const double* const a[3], const double* const b[3]);

}  // namespace lrb::torture
