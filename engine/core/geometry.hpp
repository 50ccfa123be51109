#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace lrb {

/// Returns the z component of a x b: twice the signed area of the 2D triangle 0, a, b, positive if
/// counter-clockwise. The vectors' own z components are ignored.
template <class A, class B>
double cross_2d(const A& a, const B& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Eigen's order of sums depends on the processor's vector instructions. These have one order, and the
// building of bodies uses only these, so that it gives the same bytes on all processors.

inline double dot3(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
inline double squared_norm3(const Eigen::Vector3d& a) {
  return dot3(a, a);
}
inline double norm3(const Eigen::Vector3d& a) {
  return std::sqrt(dot3(a, a));
}
/// Returns the length without overflow or underflow of squares. Eigen's stableNorm() would add the squares in
/// an order that depends on the address of its argument, and so on compiler and processor.
inline double stable_norm3(const Eigen::Vector3d& a) {
  const double largest = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
  if (!(largest > 0)) return std::abs(a[0] + a[1] + a[2]);  // 0 or NaN
  // The inverse of a subnormal number overflows, that of an infinite one makes NaN.
  constexpr double kMax = std::numeric_limits<double>::max();
  const double inverse = largest > kMax ? 1 : std::min(1 / largest, kMax);
  const double scale = inverse < kMax ? largest : 1 / kMax;
  return scale * std::sqrt(squared_norm3(a * inverse));
}
/// Returns a vector of length 1, or zero if the vector is.
inline Eigen::Vector3d normalized3(const Eigen::Vector3d& a) {
  const double square = dot3(a, a);
  return square > 0 ? Eigen::Vector3d(a / std::sqrt(square)) : a;
}
/// Returns the product of a matrix and a vector.
inline Eigen::Vector3d product3(const Eigen::Matrix3d& m, const Eigen::Vector3d& x) {
  return {(m(0, 0) * x[0] + m(0, 1) * x[1]) + m(0, 2) * x[2],
          (m(1, 0) * x[0] + m(1, 1) * x[1]) + m(1, 2) * x[2],
          (m(2, 0) * x[0] + m(2, 1) * x[1]) + m(2, 2) * x[2]};
}

/// Returns the eigenvectors of a symmetric matrix as columns, in ascending order of eigenvalues. Compiled
/// once, because the template takes seconds to compile.
Eigen::Matrix3d eigenvectors_of_symmetric(const Eigen::Matrix3d& m);

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace lrb
