#pragma once

#include "engine/core/pose.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb {

/// Returns whether a pose turns surfaces inside out, exactly. In the plane only what it does there counts.
inline bool is_reflection(const Pose& pose, int dim) {
  const Eigen::Matrix3d& r = pose.r;
  const double origin[3] = {0, 0, 0};
  return (dim == 2 ? exact::orient2d(origin, r.col(0).data(), r.col(1).data())
                   : exact::orient3d(origin, r.col(0).data(), r.col(1).data(), r.col(2).data())) < 0;
}

}  // namespace lrb
