// Convex bounds of a body as half-spaces: a discrete oriented polytope with 26 fixed directions (k-DOP;
// Klosowski et al. 1998), or the inside of a convex mesh.

#include "engine/construct/body_bounds.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace lrb::construct {

BodyBounds::BodyBounds(std::span<const Eigen::Vector3d> points, double swell) {
  // The 26 directions of the 3 x 3 x 3 stencil: 6 axes, 12 edge diagonals, 8 corner diagonals.
  for (int i = 0; i < 27; ++i) {
    if (i == 13) continue;  // the middle of the 27 is no direction
    const Eigen::Vector3d n = Eigen::Vector3d(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1).normalized();
    // The extent of the points along n. Its other end is the bound of -n, which is in the list too.
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
    // The inward normal: the body is on the positive side of each plane.
    const Eigen::Vector3d n = -(q - p).cross(r - p).normalized();
    half_spaces_.push_back({n, n.dot(p) + distance});
  }
}

}  // namespace lrb::construct
