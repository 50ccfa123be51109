#pragma once

#include <cmath>

#include <Eigen/Core>

namespace lrb {

/// Returns a bound on |d|, d the difference of two matrices that are nearly rotations. Between rotations
/// |d|^2 is half the sum of the squares of its entries. A matrix with |r^T r - 1| <= D is within D of a
/// rotation, and 2.3 (at least 1 + sqrt(3 / 2)) times the sum of both D, `defects`, is what that can add.
inline double turn_bound(const Eigen::Matrix3d& d, double defects) {
  constexpr double kToRotations = 2.3;
  return std::sqrt(d.squaredNorm() / 2) + kToRotations * defects;
}

}  // namespace lrb
