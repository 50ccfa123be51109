#include "engine/tree/pose_bounds.hpp"

#include <cmath>
#include <cstdlib>

#include "engine/core/tolerances.hpp"

namespace lrb {

double rotation_defect(const Eigen::Matrix3d& r) {
  // PropagateNaN, because a plain maximum may skip a NaN and report a small defect.
  return (r.transpose() * r - Eigen::Matrix3d::Identity())
      .cwiseAbs()
      .rowwise()
      .sum()
      .maxCoeff<Eigen::PropagateNaN>();
}

double world_size(const Pose& pose, const ObbTree& tree) {
  return pose.r.cwiseAbs().rowwise().sum().maxCoeff() * tree.extent() + pose.t.cwiseAbs().maxCoeff();
}

double wrapper_margin(const Pose& pose_a, const ObbTree& a, const Pose& pose_b, const ObbTree& b) {
  return kWrapperMargin * (world_size(pose_a, a) + world_size(pose_b, b) + kWorldUnderflow);
}

/// Scales by a power of two, which is exact, so that squares fit into doubles, and back; mostly by a product,
/// which is faster.
double stretch(const Pose& pose) {
  // Normalise so that the largest entry is in [0.5, 1).
  int exponent = 0;
  std::frexp(pose.r.cwiseAbs().maxCoeff(), &exponent);
  const Eigen::Matrix3d r = std::abs(exponent) <= 1000
                                ? Eigen::Matrix3d(pose.r * std::ldexp(1.0, -exponent))
                                : pose.r.unaryExpr([exponent](double x) { return std::ldexp(x, -exponent); });
  // The largest row sum of r^T r bounds its spectral norm, which is the square of r's.
  const double norm = std::sqrt((r.transpose() * r).cwiseAbs().rowwise().sum().maxCoeff());
  const double size = std::ldexp(norm * (1 + kWrapperMargin), exponent);
  // Results near underflow are rounded absolutely; the least normal double covers that.
  return exponent < -1000 ? size + kWorldUnderflow : size;
}

}  // namespace lrb
