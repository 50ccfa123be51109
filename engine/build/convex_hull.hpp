#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/mesh/mesh.hpp"

namespace lrb {

/// The convex hull's triangles, counter-clockwise seen from outside, as indices of points; none if all points
/// lie in one plane. Points are added one by one and all triangles tried for each (points x triangles),
/// exactly; meant for points in general position: those on a triangle's plane count as behind it.
std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const Eigen::Vector3d> points);

/// The same as a mesh of its own, with only the vertices it needs.
Mesh convex_hull_mesh(std::span<const Eigen::Vector3d> points);

}  // namespace lrb
