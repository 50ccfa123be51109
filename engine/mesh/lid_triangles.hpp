#pragma once
/// Triangulations of a hole's rim: candidates, which exact tests have to accept.

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <lrbscope/mesh.hpp>

namespace lrb::lids {

/// A vertex that does not exist yet: the middle of a fan.
inline constexpr VertexId kMiddle(kNull.kValue - 1);

struct Lid {
  std::vector<std::array<VertexId, 3>> triangles;
  std::optional<Eigen::Vector3d> middle;  ///< where kMiddle is to lie
};

/// Returns true if a triangulation may contain this edge as a diagonal.
using EdgeAllowed = std::function<bool(VertexId, VertexId)>;

/// Two coordinates in which a polygon is seen, so that it turns left.
struct LidView {
  int x = 0, y = 1;
};
/// Returns how to see a rim along the axis nearest to its mean normal; nothing if it has none.
std::optional<LidView> view_of(const Mesh& mesh, std::span<const VertexId> rim);

/// Cuts corners off a polygon, seen in two coordinates, until a triangle is left; exact, so that of a plane
/// polygon that does not cross itself every triangle lies in it and has area. A vertex may come twice (both
/// ends of a bridge to a hole). Returns nothing if it gets stuck.
std::optional<Lid> cut_corners(const Mesh& mesh, std::span<const VertexId> rim, const LidView& view,
                               const EdgeAllowed& allowed);

/// Returns the triangulation with the least area; nothing if there is none or the rim has more than
/// kMostForLeastArea vertices.
std::optional<Lid> least_area(const Mesh& mesh, std::span<const VertexId> rim, const EdgeAllowed& allowed);
inline constexpr std::size_t kMostForLeastArea = 256;  ///< the time grows with the third power

/// Returns the fan about the middle of the rim's vertices.
Lid fan_about_middle(const Mesh& mesh, std::span<const VertexId> rim);

/// Joins a polygon and the holes in it (which turn the other way) into one that passes along a bridge to each
/// hole and back, all in one plane; nothing if there is no bridge that passes between all edges.
std::optional<std::vector<VertexId>> bridge_holes(const Mesh& mesh, std::vector<VertexId> rim,
                                                  std::vector<std::vector<VertexId>> holes,
                                                  const LidView& view);

/// Returns true if a point lies inside a polygon that does not cross itself, and not on its rim: exact.
bool lies_inside(const Mesh& mesh, std::span<const VertexId> rim, VertexId point, const LidView& view);

}  // namespace lrb::lids
