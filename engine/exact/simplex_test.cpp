// Exact intersection tests of two triangles and of two segments, by orientation signs alone (Guigue and
// Devillers 2003; interval overlap after Moeller 1997). For triangles:
// 1. Corners with equal coordinates lie in both planes: no sign is computed for them.
// 2. Sides of each triangle's corners on the other's plane. All strictly on one side: disjoint.
// 3. Coplanar triangles and triangles without area: hulls_meet().
// 4. Otherwise compare the ends of the two spans on the line in which the planes cross.

#include "engine/exact/simplex_test.hpp"

#include <algorithm>

#include "engine/exact/degenerate.hpp"
#include "engine/exact/exact_sign.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/planes_cross.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::exact {
namespace {

Meet meet_on_line(const CrossingPlanes& c, bool both_mixed) {
  // Positive: b's high end is above a's low end. Negative: the spans are disjoint.
  const int above = c.order(c.on_a.low, c.on_b.high);
  if (above < 0) return Meet::disjoint;
  // The same for a's high end and b's low end.
  const int below = -c.order(c.on_a.high, c.on_b.low);
  if (below < 0) return Meet::disjoint;
  // The relative interiors intersect L in open intervals, which are empty unless the other plane cuts the
  // triangle in two.
  return both_mixed && above > 0 && below > 0 ? Meet::cross : Meet::touch;
}

Meet meet_degenerate(const double* const a[3], const double* const b[3]) {
  return hulls_meet(hull_of(a), hull_of(b)) ? Meet::touch : Meet::disjoint;
}

/// Finds the corners that two triangles have in common: number k of the first is number with[k] of the
/// second, -1 if none.
struct Shared {
  int with[3] = {-1, -1, -1};
  int count = 0;

  Shared(const double* const a[3], const double* const b[3]) {
    // `taken` pairs each corner of b once, also if a triangle repeats a corner.
    bool taken[3] = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3 && with[i] < 0; ++j) {
        if (a[i][0] != b[j][0] || taken[j] || !same_point(a[i], b[j])) continue;
        with[i] = j;
        taken[j] = true;
        ++count;
      }
  }
};

/// Returns the sides of the corners; those that are the plane's own (`own`) are on it and need no test.
Sides sides_of(const PlaneSide& plane, const double* const t[3], const bool own[3]) {
  Sides sides{};
  for (int i = 0; i < 3; ++i) sides.s[i] = own[i] ? 0 : plane.side(t[i]);
  return sides;
}

Meet meet_by_planes(const double* const a[3], const bool shared_a[3], const double* const b[3],
                    const bool shared_b[3]) {
  const PlaneSide plane_a(a[0], a[1], a[2]);
  // All zero: b is coplanar with a, or a has no area and its plane gives no sign.
  const Sides b_sides = sides_of(plane_a, b, shared_b);
  if (b_sides.all_strictly_same()) return Meet::disjoint;
  if (b_sides.all_zero()) return meet_degenerate(a, b);
  const PlaneSide plane_b(b[0], b[1], b[2]);
  const Sides a_sides = sides_of(plane_b, a, shared_a);
  // Here a's plane is well defined. All zero means that b has no area.
  if (a_sides.all_strictly_same()) return Meet::disjoint;
  if (a_sides.all_zero()) return meet_degenerate(a, b);
  return meet_on_line(CrossingPlanes(a, a_sides, b, b_sides),
                      a_sides.strictly_mixed() && b_sides.strictly_mixed());
}

}  // namespace

Meet meet_triangles(const double* const a[3], const double* const b[3]) {
  bool shared_a[3] = {}, shared_b[3] = {};
  // FloatingPredicates measures plain double arithmetic, so it takes no exact shortcut.
  if (!only_floating()) {
    const Shared shared(a, b);
    // Two common corners: the triangles share an edge, and intersect only there or are coplanar; or one of
    // them has no area.
    if (shared.count >= 2) return Meet::touch;
    for (int i = 0; i < 3; ++i) {
      if (shared.with[i] < 0) continue;
      shared_a[i] = true;
      shared_b[shared.with[i]] = true;
    }
  }
  return meet_by_planes(a, shared_a, b, shared_b);
}

Meet meet_segments(const double* const a[2], const double* const b[2]) {
  // Segments intersect exactly if neither lies strictly on one side of the other's line.
  const int b0 = orient2d(a[0], a[1], b[0]), b1 = orient2d(a[0], a[1], b[1]);
  if (b0 * b1 > 0) return Meet::disjoint;
  const int a0 = orient2d(b[0], b[1], a[0]), a1 = orient2d(b[0], b[1], a[1]);
  if (a0 * a1 > 0) return Meet::disjoint;
  // No zero: a proper crossing. Some zero, but not all: an end of one is on the other.
  if (a0 * a1 < 0 && b0 * b1 < 0) return Meet::cross;
  if (a0 != 0 || a1 != 0 || b0 != 0 || b1 != 0) return Meet::touch;
  // They are on one line (or points): they intersect if their bounding boxes do.
  for (int k = 0; k < 2; ++k) {
    const auto [a_low, a_high] = std::minmax(a[0][k], a[1][k]);
    const auto [b_low, b_high] = std::minmax(b[0][k], b[1][k]);
    if (a_high < b_low || b_high < a_low) return Meet::disjoint;
  }
  return Meet::touch;
}

}  // namespace lrb::exact
