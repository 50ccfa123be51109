#include "engine/lrb/pose.hpp"

#include <Eigen/Geometry>

namespace lrb {

Pose Pose::rotation(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& t) {
  return {Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(), t};
}

}  // namespace lrb
