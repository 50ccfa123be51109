#include "engine/exact/simplex_test.hpp"

#include <algorithm>

#include "engine/exact/degenerate.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::exact {
namespace {

/// Sides of a plane on which a triangle's corners lie.
struct Sides {
  int s[3];
  bool all_strictly_same() const { return s[0] != 0 && s[0] == s[1] && s[0] == s[2]; }
  bool all_zero() const { return s[0] == 0 && s[1] == 0 && s[2] == 0; }
  bool strictly_mixed() const { return std::min({s[0], s[1], s[2]}) < 0 && std::max({s[0], s[1], s[2]}) > 0; }
};

Sides sides_of(const PlaneSide& plane, const double* const t[3]) {
  return {{plane.side(t[0]), plane.side(t[1]), plane.side(t[2])}};
}

/// Where a triangle meets the line L in which the two planes cross: the points of L on edges (tip, toward_q)
/// and (tip, toward_r). `tip` lies strictly on side `side` of the other plane, the other ends do not. The
/// triangle's corners run tip, q, r in its own order.
struct Span {
  const double *tip, *toward_q, *toward_r;
  int side;
};

Span span_of(const double* const t[3], const Sides& sides) {
  for (int i = 0; i < 3; ++i) {
    const int q = (i + 1) % 3, r = (i + 2) % 3;
    if (sides.s[i] != 0 && sides.s[q] != sides.s[i] && sides.s[r] != sides.s[i])
      return {t[i], t[q], t[r], sides.s[i]};
  }
  // Two corners on one side, the third in the plane: L meets the triangle in that corner only.
  const int zero = sides.s[0] == 0 ? 0 : sides.s[1] == 0 ? 1 : 2;
  return {t[(zero + 1) % 3], t[zero], t[zero], sides.s[(zero + 1) % 3]};
}

/// Sign of Y - X along L, directed by normal(a) x normal(b), where X lies on edge (a.tip, a_end) of triangle
/// a and Y on edge (b.tip, b_end) of b. The two lines are in one plane exactly if X = Y; the sign follows by
/// continuity from one example.
int order_on_line(const Span& a, const double* a_end, const Span& b, const double* b_end) {
  return a.side * b.side * orient3d(a.tip, a_end, b.tip, b_end);
}

/// Triangles whose planes cross, each with corners on both sides of (or on) the other's plane.
Meet meet_on_line(const Span& a, const Span& b, bool both_mixed) {
  // Seen along L the corners of a run backwards if its tip is on the positive side, those of b forwards.
  const double* a_low = a.side > 0 ? a.toward_r : a.toward_q;
  const double* a_high = a.side > 0 ? a.toward_q : a.toward_r;
  const double* b_low = b.side > 0 ? b.toward_q : b.toward_r;
  const double* b_high = b.side > 0 ? b.toward_r : b.toward_q;
  const int above = order_on_line(a, a_low, b, b_high);
  if (above < 0) return Meet::disjoint;
  const int below = -order_on_line(a, a_high, b, b_low);
  if (below < 0) return Meet::disjoint;
  // Relative interiors meet L in open intervals, which are empty unless the other plane cuts the triangle in
  // two.
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
  return meet_on_line(span_of(a, a_sides), span_of(b, b_sides),
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
