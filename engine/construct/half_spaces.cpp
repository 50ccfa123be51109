// Convex bounds of a body as half-spaces: a discrete oriented polytope with 26 fixed directions (k-DOP;
// Klosowski et al. 1998), or the interior of a convex mesh.

#include "engine/construct/half_spaces.hpp"

#include <algorithm>
#include <cstddef>
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

// Euclidean projection of a point onto a polyhedron given by half-spaces, for three unknowns. Start at the
// target. The plane that is violated most enters the active set; those whose multipliers would become
// negative on the way leave it. At most three planes are active. Each full step increases the distance from
// the target, so the method ends; the number of steps is limited because rounding may make it cycle.

namespace {

using Vector3 = Eigen::Vector3d;

}  // namespace

std::optional<Vector3> nearest_point(const Vector3& target, std::span<const HalfSpace> half_spaces,
                                     double slack) {
  /// Below this, a direction is parallel to the active planes: a squared sine.
  constexpr double kParallel = 1e-14;
  constexpr int kMaxChanges = 40;
  Vector3 p = target;
  std::size_t active[3];
  double lambda[3];  // multipliers of the active planes
  int count = 0;
  for (int change = 0; change < kMaxChanges; ++change) {
    std::size_t worst = half_spaces.size();
    double most = slack;
    for (std::size_t i = 0; i < half_spaces.size(); ++i) {
      const double behind = half_spaces[i].d - dot3(half_spaces[i].n, p);
      if (behind > most) most = behind, worst = i;
    }
    // Nothing is violated: the optimum of the active planes is the optimum of all.
    if (worst == half_spaces.size()) return p;
    const Vector3& n = half_spaces[worst].n;
    double own = 0;  // the multiplier of the new plane
    for (;;) {
      // z: the part of n that is parallel to the active planes, along which p moves; r: the rates at which
      // their multipliers fall.
      Vector3 z = n;
      double r[3] = {0, 0, 0};
      if (count == 1) {
        const Vector3& a = half_spaces[active[0]].n;
        r[0] = dot3(a, n);
        z -= r[0] * a;
      } else if (count == 2) {
        const Vector3 &a = half_spaces[active[0]].n, &b = half_spaces[active[1]].n;
        const double ab = dot3(a, b), an = dot3(a, n), bn = dot3(b, n), det = 1 - ab * ab;
        if (!(det > 0)) return std::nullopt;
        r[0] = (an - ab * bn) / det;
        r[1] = (bn - ab * an) / det;
        z -= r[0] * a + r[1] * b;
      } else if (count == 3) {
        const Vector3 &a = half_spaces[active[0]].n, &b = half_spaces[active[1]].n,
                      &c = half_spaces[active[2]].n;
        const Vector3 bc = b.cross(c), ca = c.cross(a), ab = a.cross(b);
        const double det = dot3(a, bc);
        if (det == 0) return std::nullopt;
        r[0] = dot3(bc, n) / det;
        r[1] = dot3(ca, n) / det;
        r[2] = dot3(ab, n) / det;
        z.setZero();
      }
      // The step to the new plane, or less, if a multiplier reaches zero before.
      const double z_sq = squared_norm3(z);
      const double full_step = z_sq > kParallel ? (half_spaces[worst].d - dot3(n, p)) / z_sq : kInfinity;
      double dual_step = kInfinity;
      int leaves = -1;
      for (int i = 0; i < count; ++i)
        if (r[i] > kParallel && lambda[i] / r[i] < dual_step) dual_step = lambda[i] / r[i], leaves = i;
      const double step = std::min(dual_step, full_step);
      // No step reaches the plane: the intersection is empty.
      if (!(step < kInfinity)) return std::nullopt;
      for (int i = 0; i < count; ++i) lambda[i] -= step * r[i];
      own += step;
      if (z_sq > kParallel) p += step * z;
      if (full_step <= dual_step) {
        active[count] = worst;
        lambda[count] = own;
        ++count;
        break;
      }
      --count;
      active[leaves] = active[count];
      lambda[leaves] = lambda[count];
    }
  }
  return std::nullopt;
}

}  // namespace lrb::construct
