// Distance of points from the floor of a patch, plus the floor's own deviation: an upper estimate of the
// deviation of a cap. Bounding balls and planes cull triangles before the exact closest point is computed.

#include "engine/construct/patch_floor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/mesh/nearest_on_simplex.hpp"

namespace lrb::construct {

using Eigen::Vector3d;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

void PatchFloor::load(const HullMesh& hull, const Patch& patch, double most) {
  triangles_.clear();
  balls_.clear();
  most_ = most;
  for (const HullMesh::Slot s : patch.slots) {
    Triangle t;
    std::array<double, 3> off;
    double radius_sq = 0;
    // Deviation at the corners, the excess of the triangle included.
    for (int i = 0; i < 3; ++i) {
      const HullMesh::Point& p = hull.point(hull[s].v[i]);
      t.x[i] = p.x;
      off[i] = p.off + hull[s].extra;
    }
    t.off = off[0];
    t.off_b = off[1] - off[0];
    t.off_c = off[2] - off[0];
    t.least = *std::min_element(off.begin(), off.end());
    t.middle = (t.x[0] + t.x[1] + t.x[2]) / 3;
    for (const Vector3d& x : t.x) radius_sq = std::max(radius_sq, (x - t.middle).squaredNorm());
    t.radius = std::sqrt(radius_sq);
    set_weights(t);
    triangles_.push_back(t);
    // Points outside this ball cannot be within the limit because of this triangle.
    const double left = most - t.least, reach = left + t.radius;
    balls_.push_back({t.middle, left < 0 ? -1 : reach * reach});
  }
}

void PatchFloor::set_weights(Triangle& t) {
  const Vector3d ab = t.x[1] - t.x[0], ac = t.x[2] - t.x[0], normal = ab.cross(ac);
  const double square = normal.squaredNorm();
  // Degenerate: no weights, so that off_by() always computes the closest point.
  if (!(square > 0)) {
    t.normal = t.to_b = t.to_c = Vector3d::Zero();
    t.height = {0, 0, 0};
    t.weight = -1;
    return;
  }
  t.normal = normal / std::sqrt(square);
  // Gradients of the barycentric coordinates; the height of a corner is the inverse of its gradient's length.
  t.to_b = ac.cross(normal) / square;
  t.to_c = normal.cross(ab) / square;
  t.height = {1 / (t.to_b + t.to_c).norm(), 1 / t.to_b.norm(), 1 / t.to_c.norm()};
  t.weight = 1 / 3.;
}

/// Returns how far the triangle shows q to be off; if that is more than `most`, perhaps just that it is far.
double PatchFloor::off_by(const Triangle& t, const Vector3d& q, double most) {
  const Vector3d from_middle = q - t.middle;
  const double left = most - t.least, up = std::abs(t.normal.dot(from_middle));
  // The distance is at least that from the plane.
  if (up > left) return kFar;
  const double b = t.to_b.dot(from_middle) + t.weight, c = t.to_c.dot(from_middle) + t.weight;
  // The foot is in the triangle: the distance is the height.
  if (b >= 0 && c >= 0 && b + c <= 1) return up + t.off + b * t.off_b + c * t.off_c;
  // The distance beside the triangle is at least that from the line of each edge that the foot is beyond.
  const double beside = std::max(std::max(-b * t.height[1], -c * t.height[2]), (b + c - 1) * t.height[0]);
  if (beside * beside + up * up > left * left) return kFar;
  // Near an edge or a corner: the closest point (Ericson 2005).
  const SimplexPoint near = nearest_on_triangle(q, t.x[0], t.x[1], t.x[2]);
  return std::sqrt(near.distance_sq) + t.off + near.weight[1] * t.off_b + near.weight[2] * t.off_c;
}

double PatchFloor::off(const Vector3d& q) const {
  double best = kFar;
  for (const Triangle& t : triangles_) {
    const double left = best - t.least, reach = left + t.radius;
    // Branch and bound over the triangles with the best value so far.
    if (left <= 0 || (q - t.middle).squaredNorm() >= reach * reach) continue;
    best = std::min(best, off_by(t, q, best));
  }
  return best;
}

bool PatchFloor::is_within(const Vector3d& q, int& first) const {
  // Coherence: the triangle that answered the last query for this face usually answers the next.
  if (shows(first, q)) return true;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (!shows(t, q)) continue;
    first = static_cast<int>(t);
    return true;
  }
  return false;
}

}  // namespace lrb::construct
