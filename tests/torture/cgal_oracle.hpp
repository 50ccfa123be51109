#pragma once

namespace lrb::torture {

/// Returns true if CGAL was found when this was built.
bool has_cgal();

/// CGAL's answer to "do these triangles meet?" with exact predicates: 1 or 0; -1 if it cannot be asked (no
/// CGAL, or a triangle without area, which it does not take).
int cgal_triangles_meet(const double* const a[3], const double* const b[3]);

}  // namespace lrb::torture
