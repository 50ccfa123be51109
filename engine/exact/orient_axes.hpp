#pragma once
/// orient2d on any two coordinates of points, for work in a projection of a plane in space.

#include <cmath>

#include "engine/exact/exact_sign.hpp"

namespace lrb::exact {

/// Returns the sign of the area of a, b, c seen in coordinates x and y (indices into the points).
///
/// Error bound: each of the two products has at most four rounding errors (two differences, the product, the
/// subtraction), so the error is below 4 e (1 + 10 e) times the computed sum of magnitudes, e = 2^-53; 5 e
/// covers it. The products lose at most 2^-1074 to underflow, which kTiny exceeds. Overflow makes the bound
/// infinite or not a number, and then both comparisons are false.
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

}  // namespace lrb::exact
