#pragma once
/// Two triangles with area whose planes cross in a line L, where each has corners on both sides of the
/// other's plane, or on it: the points in which they meet L, and the order of these points along L. Private
/// to engine/exact.

#include <algorithm>

#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::exact {

/// The sides of a plane on which a triangle's corners lie.
struct Sides {
  int s[3];
  bool all_strictly_same() const { return s[0] != 0 && s[0] == s[1] && s[0] == s[2]; }
  bool all_zero() const { return s[0] == 0 && s[1] == 0 && s[2] == 0; }
  bool strictly_mixed() const { return std::min({s[0], s[1], s[2]}) < 0 && std::max({s[0], s[1], s[2]}) > 0; }
};

inline Sides sides_of(const PlaneSide& plane, const double* const t[3]) {
  return {{plane.side(t[0]), plane.side(t[1]), plane.side(t[2])}};
}

/// The part of L in a triangle: from the point of L on the edge (tip, low) to that on the edge (tip, high),
/// in the direction of normal(a) x normal(b). tip, low and high are numbers of corners. The tip lies strictly
/// on side `side` of the other plane; low and high do not. One of them that lies in the other plane is itself
/// the point on L.
struct Span {
  int tip, low, high;
  int side;
  bool is_point() const { return low == high; }
};

/// Returns the span of a triangle on L; `is_b`: it is the second of the two triangles. Seen from the front of
/// b, triangle a runs along L against the direction of normal(a) x normal(b) on the positive side, and with
/// it on the negative side; the case of b is the mirror image.
inline Span span_of(const Sides& sides, bool is_b) {
  for (int i = 0; i < 3; ++i) {
    const int q = (i + 1) % 3, r = (i + 2) % 3;
    const int side = sides.s[i];
    if (side == 0 || sides.s[q] == side || sides.s[r] == side) continue;
    return (side > 0) == is_b ? Span{i, q, r, side} : Span{i, r, q, side};
  }
  // Two corners lie on one side and the third in the plane: L meets the triangle in that corner only.
  const int zero = sides.s[0] == 0 ? 0 : sides.s[1] == 0 ? 1 : 2;
  const int tip = (zero + 1) % 3;
  return {tip, zero, zero, sides.s[tip]};
}

/// The line L and the spans of both triangles on it.
struct CrossingPlanes {
  const double* const* a;
  const double* const* b;
  Span on_a, on_b;

  CrossingPlanes(const double* const a_corners[3], const Sides& a_sides, const double* const b_corners[3],
                 const Sides& b_sides)
      : a(a_corners), b(b_corners), on_a(span_of(a_sides, false)), on_b(span_of(b_sides, true)) {}

  /// Returns the sign of Y - X along L, where X is the point of L on the edge (tip, a_end) of a and Y that on
  /// the edge (tip, b_end) of b. The lines of the two edges are in one plane exactly if X = Y; elsewhere the
  /// orientation keeps its sign, and one example fixes it.
  int order(int a_end, int b_end) const {
    return on_a.side * on_b.side * orient3d(a[on_a.tip], a[a_end], b[on_b.tip], b[b_end]);
  }
};

}  // namespace lrb::exact
