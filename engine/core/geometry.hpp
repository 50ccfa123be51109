#pragma once

#include <limits>

#include <Eigen/Core>

namespace lrb {

/// Returns the z of a x b: twice the area of the triangle 0, a, b in the plane, positive if it turns left.
/// What z the vectors have themselves does not count.
template <class A, class B>
double cross_2d(const A& a, const B& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Returns the eigenvectors of a symmetric matrix as columns, that of the least eigenvalue first. Compiled
/// once, because the compiler takes seconds for it.
Eigen::Matrix3d eigenvectors_of_symmetric(const Eigen::Matrix3d& m);

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace lrb
