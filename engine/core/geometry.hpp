#pragma once

#include <limits>

#include <Eigen/Core>

namespace lrb {

/// Returns the z component of a x b: twice the signed area of the 2D triangle 0, a, b, positive if
/// counter-clockwise. The vectors' own z components are ignored.
template <class A, class B>
double cross_2d(const A& a, const B& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Returns the eigenvectors of a symmetric matrix as columns, in ascending order of eigenvalues. Compiled
/// once, because the template takes seconds to compile.
Eigen::Matrix3d eigenvectors_of_symmetric(const Eigen::Matrix3d& m);

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace lrb
