#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <vector>

#include <Eigen/LU>

#include "engine/core/geometry.hpp"
#include "engine/distance/manifold_points.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

struct Match {
  double distance;
  std::uint32_t manifold, point, old_manifold, old_point;
  auto key() const { return std::tie(distance, manifold, point, old_manifold, old_point); }
};

/// Returns how far a point moved on A or on B, whichever is less; both are compared in the bodies' frames.
double moved_on_bodies(const ManifoldPoint& now, const ManifoldResult& result, const ManifoldPoint& before,
                       const ManifoldResult& previous) {
  double least = std::numeric_limits<double>::infinity();
  for (int side = 0; side < 2; ++side) {
    // The location of the old point if it had moved with the body.
    const Pose &from = previous.pose[side], &to = result.pose[side];
    const Vector3d carried = to.r * (from.r.inverse() * (before.point[side] - from.t)) + to.t;
    const double distance = stable_norm3(now.point[side] - carried);
    if (distance < least) least = distance;
  }
  return least;
}

}  // namespace

void number_points(ManifoldResult& result, const ManifoldResult* previous, double reach) {
  result.next_id = previous != nullptr ? previous->next_id : 0;
  std::vector<Match> matches;
  for (std::uint32_t m = 0; previous != nullptr && m < result.manifolds.size(); ++m)
    for (std::uint32_t n = 0; n < previous->manifolds.size(); ++n) {
      const ContactManifold &now = result.manifolds[m], &before = previous->manifolds[n];
      if (now.normal.dot(before.normal) < std::sqrt(0.5)) continue;
      for (std::uint32_t p = 0; p < now.points.size(); ++p)
        for (std::uint32_t q = 0; q < before.points.size(); ++q) {
          const ManifoldPoint &x = now.points[p], &y = before.points[q];
          const double moved = moved_on_bodies(x, result, y, *previous);
          // Points with the same features come before all others.
          const bool same = x.on[0] == y.on[0] && x.on[1] == y.on[1];
          if (moved <= reach) matches.push_back({same ? moved - reach : moved, m, p, n, q});
        }
    }
  std::sort(matches.begin(), matches.end(), [](const Match& x, const Match& y) { return x.key() < y.key(); });
  std::set<std::array<std::uint32_t, 2>> is_used, is_numbered;
  for (const Match& match : matches) {
    const std::array<std::uint32_t, 2> now{match.manifold, match.point},
        before{match.old_manifold, match.old_point};
    if (is_used.contains(before) || is_numbered.contains(now)) continue;
    is_used.insert(before);
    is_numbered.insert(now);
    result.manifolds[match.manifold].points[match.point].id =
        previous->manifolds[match.old_manifold].points[match.old_point].id;
  }
  for (std::uint32_t m = 0; m < result.manifolds.size(); ++m)
    for (std::uint32_t p = 0; p < result.manifolds[m].points.size(); ++p)
      if (!is_numbered.contains({m, p})) result.manifolds[m].points[p].id = result.next_id++;
}

}  // namespace lrb
