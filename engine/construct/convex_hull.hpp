#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// The convex hull's triangles, counter-clockwise seen from outside, as indices of points; none if all points
/// lie in one plane. Exact, and for every input what one gets by adding the points in order, each in place of
/// the triangles it lies strictly in front of: points on a triangle's plane count as behind it. The triangles
/// come in the order in which they arise so. Time about n log n, however many points are on the hull
/// (Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996).
std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const Eigen::Vector3d> points);

/// The same as a mesh of its own, with only the vertices it needs.
Mesh convex_hull_mesh(std::span<const Eigen::Vector3d> points);

}  // namespace lrb::construct
