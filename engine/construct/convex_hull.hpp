#pragma once

/// Convex polygons in 2D: the counterparts of closing.hpp and of convex_hull() in <lrbscope/build.hpp>.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/build.hpp>

namespace lrb::construct {

/// Returns the corners, counter-clockwise, of a convex polygon of at most max(max_sides, 4) sides that
/// contains the points, or an empty list if coordinates are too large. The points keep a distance of at least
/// half of `distance` times their largest extent from its sides (up to rounding; confirm with holds_2d()).
/// Starts from the sides of the convex hull, moved outward, and removes them one by one, always the one that
/// adds least area.
std::vector<Eigen::Vector3d> enclosing_polygon(std::span<const Eigen::Vector3d> points,
                                               std::uint32_t max_sides, double distance);

/// Returns true if the point is strictly inside a convex polygon with counter-clockwise corners. Exact.
bool holds_2d(std::span<const Eigen::Vector3d> polygon, const Eigen::Vector3d& point);

}  // namespace lrb::construct
