#pragma once
/// Parts of the exact tests of simplices: sides of several points relative to one plane, where the plane's
/// part of orient3d and of its error bound is computed once; convex hulls and projections of degenerate
/// triangles.

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "engine/exact/predicates.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::exact {

/// A number computed in doubles with a bound on its error. If it overflows, the bound is infinite or NaN.
struct Approximate {
  double value, error;
};

/// The plane through three points. Refers to the points, which must outlive it.
///
/// Error bound. Let e = 2^-53. With u = b - a, v = c - a, w = d - a the determinant is the sum of six terms
/// such as (u_y v_z) w_x. Barring underflow, each computed term is the exact one times at most eight factors
/// (1 + t), |t| <= e: three differences, the product, the subtraction inside the normal, the second product,
/// and at most two additions. So |computed - exact| <= ((1 + e)^8 - 1) P, where P is the sum of the terms'
/// magnitudes. The computed P comes from the same operations and is at least (1 - e)^8 times the exact sum.
/// Hence the error is at most 8 e (1 + 20 e) P_computed, and 9 e P_computed, rounded, exceeds that.
///
/// Underflow. Differences never underflow. The six inner products lose at most 2^-1075 each, times a
/// component of w: under 2^-1072 |w|, which 9 e * kTinyProduct * |w| exceeds. (If kTinyProduct vanishes in
/// the rounding of the sum that it is added to, the loss is below e^2 of that sum, and the step from 8 e to 9
/// e covers it.) The outer products lose 2^-1073 in total, which kTinySum exceeds. Overflow makes the bound
/// infinite or NaN, and the comparison with it false.
class PlaneSide {
 public:
  PlaneSide(const double* a, const double* b, const double* c) : a_(a), b_(b), c_(c) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    set(0, uy * vz, uz * vy);
    set(1, uz * vx, ux * vz);
    set(2, ux * vy, uy * vx);
  }

  /// Returns the determinant of orient3d(a, b, c, d).
  Approximate determinant(const double* d) const {
    const double wx = d[0] - a_[0], wy = d[1] - a_[1], wz = d[2] - a_[2];
    const double det = (normal_[0] * wx + normal_[1] * wy) + normal_[2] * wz;
    const double magnitude = (size_[0] * std::fabs(wx) + size_[1] * std::fabs(wy)) + size_[2] * std::fabs(wz);
    return {det, kDetError * magnitude + kTinySum};
  }

  /// Returns orient3d(a, b, c, d), given the determinant.
  int side(const double* d, const Approximate& det) const {
    if (det.value > det.error) return 1;
    if (det.value < -det.error) return -1;
    return orient3d_exact(a_, b_, c_, d);
  }
  int side(const double* d) const { return side(d, determinant(d)); }

  /// Returns twice the triangle's area times the height of d over the plane, rounded. For choosing between
  /// points only, not for decisions.
  double rough_height(const double* d) const {
    return (normal_[0] * (d[0] - a_[0]) + normal_[1] * (d[1] - a_[1])) + normal_[2] * (d[2] - a_[2]);
  }

  /// Returns true if the points are certainly not collinear: a component of (b - a) x (c - a), which has only
  /// four rounding errors, is larger than its error bound.
  bool surely_has_area() const {
    return std::fabs(normal_[0]) > kMinorError * size_[0] || std::fabs(normal_[1]) > kMinorError * size_[1] ||
           std::fabs(normal_[2]) > kMinorError * size_[2];
  }

 private:
  static constexpr double kDetError = 9 * 0x1p-53;
  static constexpr double kMinorError = 5 * 0x1p-53;
  static constexpr double kTinyProduct = 0x1p-900;
  static constexpr double kTinySum = 0x1p-1000;

  void set(int i, double left, double right) {
    normal_[i] = left - right;
    size_[i] = (std::fabs(left) + std::fabs(right)) + kTinyProduct;
  }

  const double *a_, *b_, *c_;
  double normal_[3], size_[3];
};

// Two triangles with area whose planes cross in a line L, each with corners on both sides of the other's
// plane, or in it: their intersections with L, and the order of these points along L. Private to
// engine/exact.

/// The sides of a triangle's corners relative to a plane.
struct Sides {
  int s[3];
  bool all_strictly_same() const { return s[0] != 0 && s[0] == s[1] && s[0] == s[2]; }
  bool all_zero() const { return s[0] == 0 && s[1] == 0 && s[2] == 0; }
  bool strictly_mixed() const { return std::min({s[0], s[1], s[2]}) < 0 && std::max({s[0], s[1], s[2]}) > 0; }
};

inline Sides sides_of(const PlaneSide& plane, const double* const t[3]) {
  return {{plane.side(t[0]), plane.side(t[1]), plane.side(t[2])}};
}

/// The part of L in a triangle: from the intersection of L with the edge (tip, low) to that with the edge
/// (tip, high), in the direction of normal(a) x normal(b). tip, low and high are corner numbers. The tip is
/// strictly on side `side` of the other plane; low and high are not. If one of them is in the other plane, it
/// is itself the point on L.
struct Span {
  int tip, low, high;
  int side;
  bool is_point() const { return low == high; }
};

/// Returns the span of a triangle on L; `is_b`: it is the second triangle. Seen from the front of b, the
/// edges of triangle a run along L against the direction of normal(a) x normal(b) on the positive side, and
/// along it on the negative side. For b the directions are reversed.
inline Span span_of(const Sides& sides, bool is_b) {
  for (int i = 0; i < 3; ++i) {
    const int q = (i + 1) % 3, r = (i + 2) % 3;
    const int side = sides.s[i];
    if (side == 0 || sides.s[q] == side || sides.s[r] == side) continue;
    return (side > 0) == is_b ? Span{i, q, r, side} : Span{i, r, q, side};
  }
  // Two corners are on one side and the third is in the plane: L intersects the triangle in that corner only.
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

  /// Returns the sign of Y - X along L, where X is the point of L on the edge (tip, a_end) of a and Y the one
  /// on the edge (tip, b_end) of b. The lines of the two edges are coplanar if and only if X = Y. Elsewhere
  /// the orientation has a constant sign, which one example determines.
  int order(int a_end, int b_end) const {
    return on_a.side * on_b.side * orient3d(a[on_a.tip], a[a_end], b[on_b.tip], b[b_end]);
  }

  /// order(a_end, b's low end) and order(a_end, b's high end).
  struct Orders {
    int low, high;
  };
  Orders orders(int a_end) const {
    const PlaneSide plane(a[on_a.tip], a[a_end], b[on_b.tip]);
    const int sign = on_a.side * on_b.side;
    return {sign * plane.side(b[on_b.low]), sign * plane.side(b[on_b.high])};
  }
};

/// Returns the intersection of the segment p, q with the plane of triangle t. p must not be in the plane, nor
/// q on p's side of it. hp, hq: PlaneSide::determinant() of that plane at p and q. Each coordinate is within
/// 1e-13 |q - p| plus one rounding of the exact point.
Eigen::Vector3d cut_by_plane(const double* p, const Approximate& hp, const double* q, const Approximate& hq,
                             const double* const t[3]);

// Coplanar triangles, and triangles with collinear corners: parts of the exact tests.

/// The convex hull of a triangle's corners, exactly: the triangle, a segment or a point.
struct Hull {
  const double* corner[3];  ///< the first dim + 1; of a segment, the lexicographic extremes of the three
  int dim;
};

Hull hull_of(const double* const t[3]);

/// A pair of coordinates such that the projections of three points are collinear only if the points are.
struct Axes {
  int x, y;
  int turn;  ///< orientation of the projected points, -1 or +1; 0: collinear
};

/// Returns axes for three points; turn = 0 if they are collinear.
Axes axes_for(const double* a, const double* b, const double* c);

/// Returns true if two hulls intersect. They may have any dimensions, but two triangles must be coplanar.
bool hulls_meet(const Hull& a, const Hull& b);

}  // namespace lrb::exact
