#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "engine/core/geometry.hpp"

namespace lrb {

/// Returns the gap between the projections of two sets of points on a direction, whichever comes first, times
/// the direction's length. Negative if they overlap.
template <class Points>
double gap_along(const Eigen::Vector3d& direction, const Points& a, const Points& b) {
  double low[2] = {kInfinity, kInfinity}, high[2] = {-kInfinity, -kInfinity};
  for (int side = 0; side < 2; ++side)
    for (const Eigen::Vector3d& x : side == 0 ? a : b) {
      const double along = direction.dot(x);
      low[side] = std::min(low[side], along);
      high[side] = std::max(high[side], along);
    }
  return std::max(low[1] - high[0], low[0] - high[1]);
}

}  // namespace lrb
