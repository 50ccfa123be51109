#pragma once
/// Triangulations of a polygon in 3D, in a projection along one axis:
/// 1. cut_corners(): ear clipping (Meisters 1975), best-shaped ear first, with exact orientation tests.
/// 2. least_area(): minimum-area triangulation by dynamic programming (Klincsek 1980), O(n^3).
/// 3. fan_about_centroid(): a fan around the centroid of the vertices.
/// 4. bridge_holes(): merges holes into the outer polygon along the shortest visible bridges, for ear
///    clipping.

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/mesh.hpp>

namespace lrb {

/// Placeholder for the new vertex at the centre of a fan.
inline constexpr VertexId kCentroid(kNull.kValue - 1);

/// A hole fill.
struct HoleFill {
  std::vector<std::array<VertexId, 3>> triangles;
  std::optional<Eigen::Vector3d> centroid;  ///< position of kCentroid
};

/// Returns true if a triangulation may contain this edge as a diagonal.
using EdgeAllowed = std::function<bool(VertexId, VertexId)>;

/// Two coordinates of a projection in which a polygon is counter-clockwise.
struct HoleProjection {
  int x = 0, y = 1;
};

/// Returns the projection of a loop along the axis closest to its mean normal, or nullopt if it has no area.
std::optional<HoleProjection> view_of(const Mesh& mesh, std::span<const VertexId> rim);

/// Triangulates a polygon by ear clipping in a projection. Exact: all triangles of a planar simple polygon
/// are inside it and have area. A vertex may occur twice (the ends of a bridge to a hole). Returns nullopt if
/// no ear is left.
std::optional<HoleFill> cut_corners(const Mesh& mesh, std::span<const VertexId> rim,
                                    const HoleProjection& view, const EdgeAllowed& allowed);

/// Returns the minimum-area triangulation, or nullopt if there is none or the loop has more than
/// kMaxForLeastArea vertices.
std::optional<HoleFill> least_area(const Mesh& mesh, std::span<const VertexId> rim,
                                   const EdgeAllowed& allowed);

/// Returns the fan around the centroid of the loop's vertices.
HoleFill fan_about_centroid(const Mesh& mesh, std::span<const VertexId> rim);

/// Merges a polygon and coplanar holes in it (of opposite orientation) into one polygon with a bridge to each
/// hole and back. Returns nullopt if a hole has no bridge that intersects no edge.
std::optional<std::vector<VertexId>> bridge_holes(const Mesh& mesh, std::vector<VertexId> rim,
                                                  std::vector<std::vector<VertexId>> holes,
                                                  const HoleProjection& view);

/// Returns true if a point is strictly inside a simple polygon. Exact.
bool lies_inside(const Mesh& mesh, std::span<const VertexId> rim, VertexId point, const HoleProjection& view);

}  // namespace lrb
