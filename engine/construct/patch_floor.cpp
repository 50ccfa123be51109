#include "engine/construct/patch_floor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/mesh/nearest_on_simplex.hpp"

namespace lrb::construct {

using Eigen::Vector3d;

void PatchFloor::load(const HullMesh& hull, const Patch& patch) {
  triangles_.clear();
  last_ = 0;
  for (const HullMesh::Slot s : patch.slots) {
    Triangle t;
    double radius_sq = 0;
    for (int i = 0; i < 3; ++i) {
      const HullMesh::Point& p = hull.point(hull[s].v[i]);
      t.x[i] = p.x;
      t.off[i] = p.off + hull[s].extra;
    }
    t.least = *std::min_element(t.off.begin(), t.off.end());
    t.middle = (t.x[0] + t.x[1] + t.x[2]) / 3;
    for (const Vector3d& x : t.x) radius_sq = std::max(radius_sq, (x - t.middle).squaredNorm());
    t.radius = std::sqrt(radius_sq);
    t.normal = (t.x[1] - t.x[0]).cross(t.x[2] - t.x[0]).normalized();
    triangles_.push_back(t);
  }
}

double PatchFloor::off_by(const Triangle& t, const Vector3d& q) {
  const SimplexPoint near = nearest_on_triangle(q, t.x[0], t.x[1], t.x[2]);
  return std::sqrt(near.distance_sq) + near.weight[0] * t.off[0] + near.weight[1] * t.off[1] +
         near.weight[2] * t.off[2];
}

double PatchFloor::off(const Vector3d& q) const {
  double best = std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangles_) {
    const double left = best - t.least;
    if (left <= 0 || std::abs(t.normal.dot(q - t.middle)) >= left) continue;
    if ((q - t.middle).squaredNorm() >= (left + t.radius) * (left + t.radius)) continue;
    best = std::min(best, off_by(t, q));
  }
  return best;
}

bool PatchFloor::is_within(const Vector3d& q, double most) const {
  const std::size_t count = triangles_.size();
  for (std::size_t i = 0, k = last_; i < count; ++i, k = k + 1 < count ? k + 1 : 0) {
    const Triangle& t = triangles_[k];
    const double left = most - t.least;
    if (left < 0 || std::abs(t.normal.dot(q - t.middle)) > left) continue;
    if ((q - t.middle).squaredNorm() > (left + t.radius) * (left + t.radius)) continue;
    if (!(off_by(t, q) <= most)) continue;
    last_ = k;
    return true;
  }
  return false;
}

}  // namespace lrb::construct
