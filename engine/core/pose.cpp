#include "engine/core/pose.hpp"

#include "engine/core/steady_math.hpp"

namespace lrb {

Pose Pose::rotation(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& t) {
  return {steady::rotation(axis.normalized(), angle), t};
}

}  // namespace lrb
