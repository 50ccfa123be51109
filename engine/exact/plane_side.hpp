#pragma once
/// Sides of a plane for several points: the plane's part of orient3d and of its error bound is computed once.

#include <cmath>

#include "engine/exact/exact_sign.hpp"

namespace lrb::exact {

/// The plane through three points. Refers to them: they must outlive it.
///
/// Error bound. Let e = 2^-53. With u = b - a, v = c - a, w = d - a the determinant is the sum of six terms
/// such as (u_y v_z) w_x. Barring underflow, each computed term is the exact one times at most eight factors
/// (1 + t), |t| <= e: three differences, the product, the subtraction inside the normal, the second product,
/// and at most two additions. So |computed - exact| <= ((1 + e)^8 - 1) P, where P is the sum of the terms'
/// magnitudes. The computed P comes from the same operations and is at least (1 - e)^8 times the exact sum.
/// Hence the error is at most 8 e (1 + 20 e) P_computed, and 9 e P_computed, rounded, exceeds that.
///
/// Underflow: differences never do. The six inner products lose at most 2^-1075 each, times a component of w:
/// under 2^-1072 |w|, which 9 e * kTinyProduct * |w| exceeds (where kTinyProduct vanishes in the rounding of
/// the sum that it is added to, the loss is below e^2 of that sum, and the step from 8 e to 9 e covers it).
/// The outer products lose 2^-1073 in all, which kTinySum exceeds. Overflow makes the bound infinite or not a
/// number, and the comparison with it false.
class PlaneSide {
 public:
  PlaneSide(const double* a, const double* b, const double* c) : a_(a), b_(b), c_(c) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    set(0, uy * vz, uz * vy);
    set(1, uz * vx, ux * vz);
    set(2, ux * vy, uy * vx);
  }

  /// Returns orient3d(a, b, c, d).
  int side(const double* d) const {
    const double wx = d[0] - a_[0], wy = d[1] - a_[1], wz = d[2] - a_[2];
    const double det = (normal_[0] * wx + normal_[1] * wy) + normal_[2] * wz;
    const double magnitude = (size_[0] * std::fabs(wx) + size_[1] * std::fabs(wy)) + size_[2] * std::fabs(wz);
    const double error = kDetError * magnitude + kTinySum;
    if (det > error) return 1;
    if (det < -error) return -1;
    return orient3d_exact(a_, b_, c_, d);
  }

  /// Returns twice the triangle's area times the height of d over the plane, rounded. Good for choosing
  /// between points, not for deciding anything.
  double rough_height(const double* d) const {
    return (normal_[0] * (d[0] - a_[0]) + normal_[1] * (d[1] - a_[1])) + normal_[2] * (d[2] - a_[2]);
  }

  /// Returns true if the points are certainly not on one line: a component of (b - a) x (c - a), which has
  /// only four rounding errors, is larger than its error.
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

}  // namespace lrb::exact
