#include "engine/tree/pose_bounds.hpp"

#include <cmath>

#include "engine/core/tolerances.hpp"

namespace lrb {

double rotation_defect(const Eigen::Matrix3d& r) {
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

double stretch(const Pose& pose) {
  return std::sqrt((pose.r.transpose() * pose.r).cwiseAbs().rowwise().sum().maxCoeff()) *
         (1 + kWrapperMargin);
}

}  // namespace lrb
