#pragma once
/// Points and components inside closed surfaces.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/mesh/box_tree.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb {

enum class PointSide { outside, inside, on_surface };

/// Locates a point relative to a closed set of faces (their triangles; 2D: segments), by the parity of an
/// exact ray.
PointSide point_side(const Mesh& mesh, std::span<const FaceId> faces, const Eigen::Vector3d& p);

/// Locates points relative to many closed surfaces, in one traversal of an AABB tree along a ray.
class SideFinder {
 public:
  /// `surface_of_face` (|F|): the surface of each face; kNull: none.
  SideFinder(const Mesh& mesh, std::vector<std::uint32_t> surface_of_face);

  struct Side {
    std::uint32_t surface;
    PointSide side;
  };
  /// Returns the surfaces that the point is in or on, ascending. It is outside all others.
  std::vector<Side> sides(const Eigen::Vector3d& p) const;

  /// Returns the surfaces that enclose the surface `inner`, ascending, given points of it. For each surface
  /// the first point that is not on it decides; a surface that contains all of the points on it does not
  /// enclose `inner`. next_point(i): the i-th point, or nullptr after the last.
  template <class NextPoint>
  std::vector<std::uint32_t> around(std::uint32_t inner, NextPoint next_point) const {
    std::vector<std::uint32_t> holders, open;
    for (std::size_t i = 0; const Eigen::Vector3d* p = next_point(i); ++i) {
      std::vector<std::uint32_t> still_open;
      for (const Side& s : sides(*p)) {
        if (s.surface == inner || (i > 0 && !std::binary_search(open.begin(), open.end(), s.surface)))
          continue;
        (s.side == PointSide::inside ? holders : still_open).push_back(s.surface);
      }
      open = std::move(still_open);
      if (open.empty()) break;
    }
    std::sort(holders.begin(), holders.end());
    return holders;
  }

 private:
  const Mesh& mesh_;
  std::map<FaceId, std::vector<std::array<VertexId, 3>>> ears_;  ///< the triangles of faces that are not fans
  std::vector<std::uint32_t> surface_of_face_;
  BoxTree tree_;  ///< of the faces of surfaces
};

/// Returns the wrongly oriented closed components, as lists of their faces, in the order of the first face. A
/// component inside an even number of others bounds a solid and must face outward; one inside an odd number
/// is a void and must face inward. Inside means entirely inside: components that cross each other are not
/// nested. Exact, except for components whose tried vertices are all on another's surface.
std::vector<std::vector<FaceId>> wrongly_facing_components(const Mesh& mesh, const std::vector<FaceUse>& use,
                                                           const SurfaceTopology& topology);

/// Returns the sign (-1, 0, +1) of the volume behind a closed set of faces, of their triangles (2D: of the
/// area left of a closed set of segments): +1 if they face outward. Exact; coordinates must be finite.
int volume_sign(const Mesh& mesh, std::span<const FaceId> faces);

}  // namespace lrb
