#include "scenarios/bodies/hull_volume.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/convex_hull.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::bodies {

double hull_volume(std::span<const Eigen::Vector3d> points) {
  const std::vector<std::array<std::uint32_t, 3>> hull = construct::convex_hull(points);
  if (hull.empty()) return 0;
  const Eigen::Vector3d o = points[hull[0][0]];
  double six = 0;
  for (const auto& [a, b, c] : hull) six += (points[a] - o).dot((points[b] - o).cross(points[c] - o));
  return six / 6;
}

double hull_area(std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> p(points.begin(), points.end());
  std::sort(p.begin(), p.end(),
            [](const auto& a, const auto& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  double twice = 0;
  for (int half = 0; half < 2; ++half) {  // Andrew's monotone chain: the lower half, then the upper one
    std::vector<Eigen::Vector3d> chain;
    for (const Eigen::Vector3d& x : p) {
      while (chain.size() > 1 &&
             exact::orient2d(chain[chain.size() - 2].data(), chain.back().data(), x.data()) <= 0)
        chain.pop_back();
      chain.push_back(x);
    }
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      twice += chain[i].x() * chain[i + 1].y() - chain[i].y() * chain[i + 1].x();
    std::reverse(p.begin(), p.end());
  }
  return twice / 2;
}

}  // namespace lrb::bodies
