#include "tests/torture/cgal_oracle.hpp"

#ifdef LRB_HAS_CGAL

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

namespace lrb::torture {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

bool has_cgal() {
  return true;
}

int cgal_triangles_meet(const double* const a[3], const double* const b[3]) {
  const auto triangle = [](const double* const t[3]) {
    const auto at = [&](int k) { return Kernel::Point_3(t[k][0], t[k][1], t[k][2]); };
    return Kernel::Triangle_3(at(0), at(1), at(2));
  };
  const Kernel::Triangle_3 ta = triangle(a), tb = triangle(b);
  if (ta.is_degenerate() || tb.is_degenerate()) return -1;
  return CGAL::do_intersect(ta, tb) ? 1 : 0;
}

}  // namespace lrb::torture

#else

namespace lrb::torture {

bool has_cgal() {
  return false;
}
int cgal_triangles_meet(const double* const*, const double* const*) {
  return -1;
}

}  // namespace lrb::torture

#endif
