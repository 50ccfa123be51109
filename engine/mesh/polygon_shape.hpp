#pragma once
/// Exact answers about the shape of one polygon in space.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <lrbscope/mesh.hpp>

namespace lrb {

/// Returns three corners that span a plane; nothing if all corners lie on one line (the polygon has no area).
std::optional<std::array<VertexId, 3>> spanning_corners(const Mesh& mesh, std::span<const VertexId> corners);

/// Returns true if all corners lie in the plane of these three.
bool is_planar(const Mesh& mesh, std::span<const VertexId> corners, const std::array<VertexId, 3>& plane);

/// Returns true if the polygon is convex, seen along the axis nearest to its normal. Corners in the middle of
/// a straight side are allowed, sides that turn back are not. For a polygon with area.
bool is_convex(const Mesh& mesh, std::span<const VertexId> corners);

/// Splits a planar convex polygon with area into triangles: the fan from the first corner, unless corners in
/// the middle of straight sides would give that fan triangles without area; then others that all have area.
/// (Corners that lie in one place can still make triangles without area.)
void triangulate_convex(const Mesh& mesh, std::span<const VertexId> corners,
                        std::vector<std::array<VertexId, 3>>& triangles);

/// Splits a polygon with very many corners in the same way into triangles of all sizes, few of them large and
/// none longer than the part of the rim that it cuts off, so that boxes around them overlap little.
void triangulate_by_halves(const Mesh& mesh, std::span<const VertexId> corners,
                           std::vector<std::array<VertexId, 3>>& triangles);

}  // namespace lrb
