#pragma once
/// Sorts polygons for painting, so that nearer ones cover farther ones.
///
/// Unlike a sort by distance it is exact: polygons that intersect or overlap cyclically are split. A single
/// painting pass then blends all layers correctly at every pixel, at a tenth of the cost of depth peeling
/// (measured).
///
/// Method: binary space partition. Many polygons are split by planes perpendicular to an axis, through the
/// median (the polygons' own planes would turn a convex shell into a list); few polygons are split by their
/// own planes.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lrb::render {

/// A convex polygon in the eye's frame (x right, y up, z = distance in front of the eye).
struct EyePolygon {
  std::vector<Eigen::Vector3d> x;
  Eigen::Vector3d normal;    ///< not necessarily unit
  std::uint32_t source = 0;  ///< user data; pieces keep it
};

/// Returns the polygons, or the pieces they were split into, farthest first. Coplanar polygons keep their
/// order; those with zero area (normal zero) are dropped. The viewer is at the origin; orthographic:
/// infinitely far away, looking along +z.
std::vector<EyePolygon> back_to_front(std::vector<EyePolygon> polygons, bool orthographic);

}  // namespace lrb::render
