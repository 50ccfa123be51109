#pragma once
/// Exact signs of determinants of doubles: a floating-point filter first, then exact arithmetic if the filter
/// cannot decide. Points are arrays of finite doubles of any magnitude (3D: x, y, z; 2D: x, y).

#include <array>
#include <cmath>

namespace lrb::exact {

// The exact evaluation behind the predicates, used when a floating-point filter cannot decide. Private to the
// engine.

/// Return orient2d in the coordinates `x` and `y` of the points, and orient3d, without a filter.
int orient2d_exact(const double* a, const double* b, const double* c, int x, int y);
int orient3d_exact(const double* a, const double* b, const double* c, const double* d);

/// The coordinates of the points a, b, c, d along x, along y and along z.
using Coordinates4 = std::array<std::array<double, 4>, 3>;

/// The two evaluations of orient3d: with long integers (for all finite doubles), and with expansions if they
/// apply.
int orient3d_integer(const Coordinates4& p);
int orient3d_expansion(const Coordinates4& p);
bool expansions_apply(const Coordinates4& p);

inline bool same_point(const double* a, const double* b) {
  return a == b || (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
}

// orient2d in any two coordinates, for projections of a plane in 3D.

/// Returns the sign of the area of a, b, c projected to coordinates x and y (indices into the points).
///
/// Error bound: each of the two products has at most four rounding errors (two differences, the product, the
/// subtraction), so the error is below 4 e (1 + 10 e) times the computed sum of magnitudes, e = 2^-53; 5 e
/// covers it. The products lose at most 2^-1074 to underflow, which kTiny exceeds. Overflow makes the bound
/// infinite or NaN, and then both comparisons are false.
inline int orient_axes(const double* a, const double* b, const double* c, int x, int y) {
  constexpr double kError = 5 * 0x1p-53;
  constexpr double kTiny = 0x1p-1000;
  const double left = (b[x] - a[x]) * (c[y] - a[y]);
  const double right = (b[y] - a[y]) * (c[x] - a[x]);
  const double det = left - right;
  const double error = kError * (std::fabs(left) + std::fabs(right)) + kTiny;
  if (det > error) return 1;
  if (det < -error) return -1;
  return orient2d_exact(a, b, c, x, y);
}

/// Returns the sign (-1, 0, +1) of the area of the 2D triangle a, b, c: +1 if counter-clockwise.
int orient2d(const double* a, const double* b, const double* c);

/// Returns the sign of det[b - a; c - a; d - a]: +1 if d is on the side of plane (a, b, c) that the normal of
/// the triangle points to, so that a, b, c appear counter-clockwise from d; 0 if coplanar. The normal is
/// (b - a) x (c - a).
int orient3d(const double* a, const double* b, const double* c, const double* d);

/// Returns true if a, b, c are collinear (or coincide), in 3D.
bool collinear3d(const double* a, const double* b, const double* c);

/// Disables exactness on this thread during its lifetime: signs that the filter cannot decide are those of
/// plain double arithmetic, and may be wrong. Exists to measure the cost and benefit of exactness.
class FloatingPredicates {
 public:
  explicit FloatingPredicates(bool on = true);
  ~FloatingPredicates();
  FloatingPredicates(const FloatingPredicates&) = delete;
  FloatingPredicates& operator=(const FloatingPredicates&) = delete;

 private:
  bool before_;
};

/// Returns true while a FloatingPredicates exists on this thread.
bool only_floating();

}  // namespace lrb::exact
