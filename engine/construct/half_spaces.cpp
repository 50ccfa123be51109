// Convex bounds of a body as half-spaces: a discrete oriented polytope with 26 fixed directions (k-DOP;
// Klosowski et al. 1998), or the interior of a convex mesh.

#include "engine/construct/half_spaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb::construct {

BodyBounds::BodyBounds(std::span<const Eigen::Vector3d> points, double swell) {
  // The 26 directions of the 3 x 3 x 3 stencil: 6 axes, 12 edge diagonals, 8 corner diagonals.
  for (int i = 0; i < 27; ++i) {
    if (i == 13) continue;  // the centre of the stencil has no direction
    const Eigen::Vector3d n = normalized3(Eigen::Vector3d(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1));
    // The extent of the points along n. The upper end is the bound of -n, which is in the list as well.
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Eigen::Vector3d& p : points) {
      low = std::min(low, dot3(n, p));
      high = std::max(high, dot3(n, p));
    }
    half_spaces_.push_back({n, low - swell * (high - low)});
  }
}

BodyBounds::BodyBounds(const Mesh& convex, double distance) {
  for (FaceId f = 0; f < convex.face_count(); ++f) {
    const auto c = convex.face(f);
    const Eigen::Vector3d &p = convex.vertices[c[0]], &q = convex.vertices[c[1]], &r = convex.vertices[c[2]];
    // The inward normal: the body is on the positive side of each plane.
    const Eigen::Vector3d n = -normalized3((q - p).cross(r - p));
    half_spaces_.push_back({n, dot3(n, p) + distance});
  }
}

// Euclidean projection of a point onto a polyhedron given by half-spaces: a small convex quadratic programme,
// solved incrementally after Seidel (1991), who solves linear programmes in this way. If the optimum of the
// first i half-spaces violates the next one, the new optimum is on that one's boundary plane, by convexity.
// 1. 3D: add the half-spaces one by one and keep the point while it satisfies them.
// 2. 2D: on the plane of a violated half-space, do the same with the half-planes cut out by the earlier
//    half-spaces.
// 3. 1D: on the line of a violated half-plane, intersect intervals and clamp.

namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;

/// A plane with coordinates: its point nearest to the target, as the origin, and two orthonormal axes.
struct Frame {
  Vector3 origin, x, y;
};

Frame frame_on(const HalfSpace& h, const Vector3& target) {
  Frame f;
  // With the origin at the target's foot, squared distances to the target and to the origin differ by a
  // constant: the nearest point on the plane is the one nearest to the origin.
  f.origin = target + h.n * (h.d - dot3(h.n, target));
  // The coordinate axis closest to the plane: its sine to n is at least sqrt(2/3), so that the cross product
  // is accurate.
  int least = 0;
  h.n.cwiseAbs().minCoeff(&least);
  f.x = normalized3(h.n.cross(Vector3::Unit(least)));
  // Both factors have unit length and are orthogonal, so y needs no normalisation.
  f.y = h.n.cross(f.x);
  return f;
}

/// The half-plane a.p >= b (a need not be of unit length) that a half-space cuts out of the frame's plane.
struct HalfPlane {
  Vector2 a;
  double b;
  bool parallel;  ///< parallel to the plane: contains all of it or nothing
};

HalfPlane cut(const HalfSpace& h, const Frame& f) {
  // Substitute origin + x p.x + y p.y into n.x >= d. The length of `a` is the sine between the two planes.
  const Vector2 a(dot3(h.n, f.x), dot3(h.n, f.y));
  return {a, h.d - dot3(h.n, f.origin), dot2(a, a) < kParallelSineSq};
}

/// Returns the point nearest to the origin on the boundary line `edge` of a half-plane that is in the
/// half-spaces `before`, or nullopt if they leave no point of it.
std::optional<Vector2> nearest_on_line(const HalfPlane& edge, std::span<const HalfSpace> before,
                                       const Frame& frame, double slack) {
  // Parametrise the line by arc length from its point nearest to the origin: the optimum is the smallest |t|.
  const double length_sq = dot2(edge.a, edge.a);
  const Vector2 start = edge.a * (edge.b / length_sq);
  const Vector2 along = Vector2(-edge.a.y(), edge.a.x()) / std::sqrt(length_sq);
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  // Each earlier half-space leaves a ray of the line. The rays intersect in [low, high].
  for (const HalfSpace& h : before) {
    const HalfPlane c = cut(h, frame);
    const double slope = dot2(c.a, along), needed = c.b - dot2(c.a, start);
    if (slope * slope < kParallelSineSq) {
      // Parallel to the line: the entire line satisfies it, or none of it.
      if (needed > slack) return std::nullopt;
    } else if (slope > 0) {
      low = std::max(low, needed / slope);
    } else {
      high = std::min(high, needed / slope);
    }
  }
  // Intervals that miss each other by less than `slack` count as one point, because rounding could have
  // caused the gap.
  if (low > high + slack) return std::nullopt;
  // Clamp t = 0, the optimum without the other half-spaces, to the interval.
  const double t = low > 0 ? low : high < 0 ? high : 0;
  return Vector2(start + along * t);
}

std::optional<Vector3> nearest_on_plane(const HalfSpace& last, std::span<const HalfSpace> before,
                                        const Vector3& target, double slack) {
  // The 2D problem: start from the target's foot and add the earlier half-spaces one by one.
  const Frame frame = frame_on(last, target);
  Vector2 p = Vector2::Zero();
  for (std::size_t i = 0; i < before.size(); ++i) {
    const HalfPlane c = cut(before[i], frame);
    // The point satisfies this half-plane: it remains the optimum.
    if (dot2(c.a, p) >= c.b - slack) continue;
    // The planes are parallel and the half-space does not contain this one: infeasible.
    if (c.parallel) return std::nullopt;
    // Violated: the optimum moves to the boundary line.
    const auto q = nearest_on_line(c, before.first(i), frame, slack);
    if (!q) return std::nullopt;
    p = *q;
  }
  // Back to 3D coordinates.
  return Vector3(frame.origin + frame.x * p.x() + frame.y * p.y());
}

}  // namespace

std::optional<Vector3> nearest_point(const Vector3& target, std::span<const HalfSpace> half_spaces,
                                     double slack) {
  Vector3 p = target;
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    const HalfSpace& h = half_spaces[i];
    // In random order, half-space i is violated with probability at most 3 / i: expected linear time.
    if (dot3(h.n, p) >= h.d - slack) continue;
    // Violated: the optimum is on this plane, subject to the half-spaces before it.
    const auto q = nearest_on_plane(h, half_spaces.first(i), target, slack);
    if (!q) return std::nullopt;
    p = *q;
  }
  return p;
}

std::optional<Vector3> nearest_point_worst_first(const Vector3& target, std::span<HalfSpace> half_spaces,
                                                 double slack) {
  Vector3 p = target;
  // The first `used` half-spaces have been added; p is their optimum. Each round adds one, so this
  // terminates.
  for (std::size_t used = 0;; ++used) {
    std::size_t worst = half_spaces.size();
    double most = slack;
    // Pricing step, as in an active-set method: the most violated constraint enters.
    for (std::size_t i = used; i < half_spaces.size(); ++i) {
      const double behind = half_spaces[i].d - dot3(half_spaces[i].n, p);
      if (behind > most) most = behind, worst = i;
    }
    // Nothing is violated: the optimum of a subset that satisfies all constraints is the optimum of all.
    if (worst == half_spaces.size()) return p;
    // Keep the added ones in front, as the solver requires.
    std::swap(half_spaces[used], half_spaces[worst]);
    const auto q = nearest_on_plane(half_spaces[used], half_spaces.first(used), target, slack);
    if (!q) return std::nullopt;
    p = *q;
  }
}

}  // namespace lrb::construct
