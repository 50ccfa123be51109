#include "engine/build/body_bounds.hpp"

#include <algorithm>
#include <limits>

namespace lrb {
namespace {

constexpr double kSwell = 0.05;  ///< of the body's width, on each side

}  // namespace

BodyBounds::BodyBounds(std::span<const Eigen::Vector3d> points) {
  std::size_t next = 0;
  for (int i = 0; i < 27; ++i) {
    if (i == 13) continue;  // the middle of 27: no direction
    const Eigen::Vector3d n = Eigen::Vector3d(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1).normalized();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Eigen::Vector3d& p : points) {
      low = std::min(low, n.dot(p));
      high = std::max(high, n.dot(p));
    }
    half_spaces_[next++] = {n, low - kSwell * (high - low)};
  }
}

}  // namespace lrb
