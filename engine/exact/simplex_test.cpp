#include "engine/exact/simplex_test.hpp"

#include <algorithm>

#include "engine/exact/degenerate.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/planes_cross.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::exact {
namespace {

Meet meet_on_line(const CrossingPlanes& c, bool both_mixed) {
  const int above = c.order(c.on_a.low, c.on_b.high);
  if (above < 0) return Meet::disjoint;
  const int below = -c.order(c.on_a.high, c.on_b.low);
  if (below < 0) return Meet::disjoint;
  // Relative interiors meet L in open intervals, which are empty unless the other plane cuts the triangle
  // in two.
  return both_mixed && above > 0 && below > 0 ? Meet::cross : Meet::touch;
}

Meet meet_degenerate(const double* const a[3], const double* const b[3]) {
  return hulls_meet(hull_of(a), hull_of(b)) ? Meet::touch : Meet::disjoint;
}

Meet meet_by_planes(const PlaneSide& plane_a, const double* const a[3], const PlaneSide& plane_b,
                    const double* const b[3]) {
  const Sides b_sides = sides_of(plane_a, b);
  if (b_sides.all_strictly_same()) return Meet::disjoint;
  if (b_sides.all_zero()) return meet_degenerate(a, b);
  const Sides a_sides = sides_of(plane_b, a);
  if (a_sides.all_strictly_same()) return Meet::disjoint;
  if (a_sides.all_zero()) return meet_degenerate(a, b);
  return meet_on_line(CrossingPlanes(a, a_sides, b, b_sides),
                      a_sides.strictly_mixed() && b_sides.strictly_mixed());
}

}  // namespace

Meet meet_triangles(const double* const a[3], const double* const b[3]) {
  const PlaneSide plane_a(a[0], a[1], a[2]);
  const PlaneSide plane_b(b[0], b[1], b[2]);
  return meet_by_planes(plane_a, a, plane_b, b);
}

Meet meet_segments(const double* const a[2], const double* const b[2]) {
  const int b0 = orient2d(a[0], a[1], b[0]), b1 = orient2d(a[0], a[1], b[1]);
  if (b0 * b1 > 0) return Meet::disjoint;
  const int a0 = orient2d(b[0], b[1], a[0]), a1 = orient2d(b[0], b[1], a[1]);
  if (a0 * a1 > 0) return Meet::disjoint;
  if (a0 * a1 < 0 && b0 * b1 < 0) return Meet::cross;
  if (a0 != 0 || a1 != 0 || b0 != 0 || b1 != 0) return Meet::touch;
  // On one line (or points): they meet if their boxes do.
  for (int k = 0; k < 2; ++k) {
    const auto [a_low, a_high] = std::minmax(a[0][k], a[1][k]);
    const auto [b_low, b_high] = std::minmax(b[0][k], b[1][k]);
    if (a_high < b_low || b_high < a_low) return Meet::disjoint;
  }
  return Meet::touch;
}

}  // namespace lrb::exact
