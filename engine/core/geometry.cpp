#include "engine/core/geometry.hpp"

#include <Eigen/Eigenvalues>

namespace lrb {

Eigen::Matrix3d eigenvectors_of_symmetric(const Eigen::Matrix3d& m) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvectors();
}

}  // namespace lrb
