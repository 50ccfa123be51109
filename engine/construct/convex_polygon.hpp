#pragma once
/// closing.hpp and convex_hull.hpp, one dimension down.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lrb::construct {

/// Indices of the points on the boundary of the convex hull, counter-clockwise, those in the middle of its
/// sides included; no two of them are the same point. z is ignored. Exact. Fewer than three if all points are
/// on one line. (Monotone chains: Andrew 1979.)
std::vector<std::uint32_t> convex_outline(std::span<const Eigen::Vector3d> points);

/// A convex polygon of at most `max_sides` (4 if fewer are asked for: a box) that holds the points with at
/// least half of `distance` times their largest extent to spare (to rounding; confirm with holds_2d()):
/// counter-clockwise corners. Empty if coordinates are too large. Sides of the convex hull, moved outward,
/// are left out one by one, always the one that adds least area.
std::vector<Eigen::Vector3d> enclosing_polygon(std::span<const Eigen::Vector3d> points,
                                               std::uint32_t max_sides, double distance);

/// True if the point lies strictly inside a convex polygon with counter-clockwise corners. Exact.
bool holds_2d(std::span<const Eigen::Vector3d> polygon, const Eigen::Vector3d& point);

}  // namespace lrb::construct
