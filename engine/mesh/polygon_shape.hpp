#pragma once
/// Exact tests of the shape of one polygon in 3D, and its triangulations.

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/mesh.hpp>

namespace lrb {

/// Returns the normal of a polygon of `n` corners at(i) by Newell's method, for the polygon divided by its
/// size, and the size: its largest coordinate. The division avoids overflow.
template <class At>
std::pair<Eigen::Vector3d, double> newell_normal(std::size_t n, const At& at) {
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) size = std::max(size, at(i).cwiseAbs().maxCoeff());
  const Eigen::Vector3d origin = at(0) / size;
  Eigen::Vector3d sum(0, 0, 0);
  for (std::size_t i = 1; i + 1 < n; ++i) sum += (at(i) / size - origin).cross(at(i + 1) / size - origin);
  return {sum, size};
}

/// Returns the height of a triangle divided by its longest edge; NaN if its corners coincide.
double relative_height(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z);

/// Returns three corners that span a plane, or nullopt if all corners are collinear (the polygon has no
/// area).
std::optional<std::array<VertexId, 3>> spanning_corners(const Mesh& mesh, std::span<const VertexId> corners);

/// Returns true if all corners are in the plane of these three.
bool is_planar(const Mesh& mesh, std::span<const VertexId> corners, const std::array<VertexId, 3>& plane);

/// Returns true if the polygon is convex in the projection along the axis closest to its normal. Corners
/// inside a straight side are allowed, sides that reverse direction are not. The polygon must have area.
bool is_convex(const Mesh& mesh, std::span<const VertexId> corners);

/// Triangulates a planar convex polygon with area: by the fan from the first corner, unless corners inside
/// straight sides would give it degenerate triangles; then by other triangles, which all have area.
/// (Coincident corners can still lead to degenerate triangles.)
void triangulate_convex(const Mesh& mesh, std::span<const VertexId> corners,
                        std::vector<std::array<VertexId, 3>>& triangles);

/// Triangulates a face without degenerate triangles if it is planar and convex, otherwise by cut_polygon().
void triangulate(const Mesh& mesh, FaceId f, std::vector<std::array<VertexId, 3>>& triangles);

/// Triangulates a polygon with very many corners into triangles of all sizes. Few of them are large, and none
/// is longer than the part of the boundary that it cuts off, so that their boxes overlap little.
void triangulate_by_halves(const Mesh& mesh, std::span<const VertexId> corners,
                           std::vector<std::array<VertexId, 3>>& triangles);

}  // namespace lrb
