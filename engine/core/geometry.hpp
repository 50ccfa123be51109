#pragma once

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
inline double dot2(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a[0] * b[0] + a[1] * b[1];
}
inline double squared_norm3(const Eigen::Vector3d& a) {
  return dot3(a, a);
}
inline double norm3(const Eigen::Vector3d& a) {
  return std::sqrt(dot3(a, a));
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
