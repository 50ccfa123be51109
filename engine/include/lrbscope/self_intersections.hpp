#pragma once
/// All pairs of faces in which a mesh intersects itself, with the segments in which they do.
///
/// Two faces intersect themselves if they share a point beyond the corners and edges that they share by
/// index: the definition of the checks (MeshFault::self_intersection), of the builder and of clash(). Exact.
/// Faces without area are left out (2D: without length; the checks report them), and a polygon is not
/// compared with itself. Polygons are divided into triangles (cut_polygon()). Corners with equal coordinates
/// but different indices are different: merge them first (join_corners()).
///
/// Algorithm: pairs whose boxes overlap, from an AABB tree (OBBs where very many AABBs overlap); then signs
/// of determinants, exactly (interval overlap, Moeller 1997). Ends of segments are identified by the
/// vertices, edges and triangles that they are on, so that curves are connected without comparing
/// coordinates.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb {

class LrbRep;

/// How two faces of a mesh intersect beyond what they share.
enum class SelfContact : std::uint8_t {
  touch,    ///< in points and segments, without passing through each other
  cross,    ///< they pass through each other
  overlap,  ///< they cover an area of one plane (2D: a length of one line)
};
constexpr auto enum_names(SelfContact) {
  return std::to_array<EnumName<SelfContact>>(
      {{SelfContact::touch, "touch"}, {SelfContact::cross, "cross"}, {SelfContact::overlap, "overlap"}});
}

struct SelfIntersection {
  FaceId a, b;  ///< a < b
  SelfContact kind = SelfContact::touch;
  std::uint32_t shared = 0;  ///< number of corners in common, by index; 2: usually an edge
  std::uint32_t curve = 0;   ///< connected component of all segments that has those of this pair
  std::uint32_t first_segment = 0, segments = 0;  ///< in SelfIntersections::segments
};

struct SelfIntersections {
  std::vector<SelfIntersection> pairs;  ///< ascending by a, then b
  /// Ends of the segments in the mesh's frame and unit, rounded as ContactCorner::x; equal for points.
  /// Segments that meet in an end have it with the same coordinates. An overlap has the outline of each of
  /// its polygons. The corners and edges that faces share may be included.
  std::vector<std::array<Eigen::Vector3d, 2>> segments;
  std::uint32_t curves = 0;  ///< number of connected components
};

/// Maximum number of pairs unless another is given.
inline constexpr std::uint64_t kMaxSelfIntersections = std::uint64_t{1} << 24;

/// Returns the pairs of a mesh or of the real faces of a body. The result does not depend on `threads` (0:
/// all cores). Throws InputError if there are more than max_pairs.
SelfIntersections self_intersections(const CheckedMesh& mesh, unsigned threads = 0,
                                     std::uint64_t max_pairs = kMaxSelfIntersections);
SelfIntersections self_intersections(const LrbRep& rep, unsigned threads = 0,
                                     std::uint64_t max_pairs = kMaxSelfIntersections);

}  // namespace lrb
