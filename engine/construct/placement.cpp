#include "engine/construct/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"

namespace lrb::construct {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;

/// A plane with coordinates: origin (its point nearest to the target) and two axes of length 1.
struct Frame {
  Vector3 origin, x, y;
};

Frame frame_on(const HalfSpace& h, const Vector3& target) {
  Frame f;
  f.origin = target + h.n * (h.d - h.n.dot(target));
  int least = 0;
  h.n.cwiseAbs().minCoeff(&least);
  f.x = h.n.cross(Vector3::Unit(least)).normalized();
  f.y = h.n.cross(f.x);
  return f;
}

/// The half-plane a.p >= b (a need not have length 1) in which a half-space cuts the frame's plane.
struct HalfPlane {
  Vector2 a;
  double b;
  bool parallel;  ///< parallel to the plane: holds all of it or nothing
};

HalfPlane cut(const HalfSpace& h, const Frame& f) {
  const Vector2 a(h.n.dot(f.x), h.n.dot(f.y));
  return {a, h.d - h.n.dot(f.origin), a.squaredNorm() < kParallelSineSq};
}

/// Returns the point nearest to the origin on the boundary line `edge` of a half-plane, within the
/// half-spaces `before`.
std::optional<Vector2> nearest_on_line(const HalfPlane& edge, std::span<const HalfSpace> before,
                                       const Frame& frame, double slack) {
  const double length_sq = edge.a.squaredNorm();
  const Vector2 start = edge.a * (edge.b / length_sq);
  const Vector2 along = Vector2(-edge.a.y(), edge.a.x()) / std::sqrt(length_sq);
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (const HalfSpace& h : before) {
    const HalfPlane c = cut(h, frame);
    const double slope = c.a.dot(along), needed = c.b - c.a.dot(start);
    if (slope * slope < kParallelSineSq) {
      if (needed > slack) return std::nullopt;
    } else if (slope > 0) {
      low = std::max(low, needed / slope);
    } else {
      high = std::min(high, needed / slope);
    }
  }
  if (low > high + slack) return std::nullopt;
  const double t = low > 0 ? low : high < 0 ? high : 0;
  return Vector2(start + along * t);
}

std::optional<Vector3> nearest_on_plane(const HalfSpace& last, std::span<const HalfSpace> before,
                                        const Vector3& target, double slack) {
  const Frame frame = frame_on(last, target);
  Vector2 p = Vector2::Zero();
  for (std::size_t i = 0; i < before.size(); ++i) {
    const HalfPlane c = cut(before[i], frame);
    if (c.a.dot(p) >= c.b - slack) continue;
    if (c.parallel) return std::nullopt;
    const auto q = nearest_on_line(c, before.first(i), frame, slack);
    if (!q) return std::nullopt;
    p = *q;
  }
  return Vector3(frame.origin + frame.x * p.x() + frame.y * p.y());
}

}  // namespace

std::optional<Vector3> nearest_point(const Vector3& target, std::span<const HalfSpace> half_spaces,
                                     double slack) {
  Vector3 p = target;
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    const HalfSpace& h = half_spaces[i];
    if (h.n.dot(p) >= h.d - slack) continue;
    const auto q = nearest_on_plane(h, half_spaces.first(i), target, slack);
    if (!q) return std::nullopt;
    p = *q;
  }
  return p;
}

std::optional<Vector3> nearest_point_worst_first(const Vector3& target, std::span<HalfSpace> half_spaces,
                                                 double slack) {
  Vector3 p = target;
  for (std::size_t used = 0;; ++used) {
    std::size_t worst = half_spaces.size();
    double most = slack;
    for (std::size_t i = used; i < half_spaces.size(); ++i) {
      const double behind = half_spaces[i].d - half_spaces[i].n.dot(p);
      if (behind > most) most = behind, worst = i;
    }
    if (worst == half_spaces.size()) return p;
    std::swap(half_spaces[used], half_spaces[worst]);
    const auto q = nearest_on_plane(half_spaces[used], half_spaces.first(used), target, slack);
    if (!q) return std::nullopt;
    p = *q;
  }
}

}  // namespace lrb::construct
