#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Returns the convex hull's triangles, counter-clockwise seen from outside, as indices of points; none if
/// all points lie in one plane. Exact, and for every input the result of adding the points in order, each in
/// place of the triangles that it lies strictly in front of: points on a triangle's plane count as behind it.
/// The triangles are listed in the order in which they arise that way. Takes about n log n time, however many
/// points are on the hull (Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996).
std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const Eigen::Vector3d> points);

/// Returns the same hull as a mesh, with only the vertices that it needs.
Mesh convex_hull_mesh(std::span<const Eigen::Vector3d> points);

}  // namespace lrb::construct
