#include "engine/construct/body_bounds.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace lrb::construct {

BodyBounds::BodyBounds(std::span<const Eigen::Vector3d> points, double swell) {
  for (int i = 0; i < 27; ++i) {
    if (i == 13) continue;  // the middle of the 27 is no direction
    const Eigen::Vector3d n = Eigen::Vector3d(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1).normalized();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Eigen::Vector3d& p : points) {
      low = std::min(low, n.dot(p));
      high = std::max(high, n.dot(p));
    }
    half_spaces_.push_back({n, low - swell * (high - low)});
  }
}

BodyBounds::BodyBounds(const Mesh& convex, double distance) {
  for (FaceId f = 0; f < convex.face_count(); ++f) {
    const auto c = convex.face(f);
    const Eigen::Vector3d &p = convex.vertices[c[0]], &q = convex.vertices[c[1]], &r = convex.vertices[c[2]];
    const Eigen::Vector3d n = -(q - p).cross(r - p).normalized();
    half_spaces_.push_back({n, n.dot(p) + distance});
  }
}

}  // namespace lrb::construct
