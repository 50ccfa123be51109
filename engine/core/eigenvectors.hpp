#pragma once

#include <Eigen/Core>

namespace lrb {

/// Returns the eigenvectors of a symmetric matrix as columns, that of the least eigenvalue first. Compiled
/// once, because the compiler takes seconds for it.
Eigen::Matrix3d eigenvectors_of_symmetric(const Eigen::Matrix3d& m);

}  // namespace lrb
