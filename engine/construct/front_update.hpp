#pragma once
/// Applies a cap to the front: adds its faces and regions to the complex, and replaces the covered triangles
/// of the front.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/complex_builder.hpp"
#include "engine/construct/front_mesh.hpp"
#include <lrbscope/build.hpp>

namespace lrb::construct {

// Splits the space between two surfaces with the same boundary into regions.

/// A triangle: its corners as indices of points, counter-clockwise seen from outside.
using PointTriangle = std::array<std::uint32_t, 3>;

/// The pieces of a space, numbered from 0, and the piece that each triangle bounds.
struct RegionPieces {
  std::uint32_t count = 0;
  std::uint32_t merged = 0;             ///< pieces without volume that were merged into another piece...
  std::uint32_t into = 0;               ///< ...which is this one
  std::vector<std::uint32_t> of_old;    ///< (|old|)
  std::vector<std::uint32_t> of_added;  ///< (|added|)
};

/// Splits the space between the surface `old` and the surface `added` in front of it into pieces. (Triangles
/// that both have in common are in neither list.) `old_face`: equal for the triangles of one polygon, which
/// must be adjacent in the list. Pieces are connected over edges; where the surfaces touch in an edge, the
/// spaces on its two sides are different pieces. A piece without volume is the inner shell of another piece
/// and is merged into the largest one.
RegionPieces split_region(std::span<const PointTriangle> old, std::span<const std::uint32_t> old_face,
                          std::span<const PointTriangle> added, std::span<const Eigen::Vector3d> points);

/// Directed edges of triangles, for look-up.
class EdgeIndex {
 public:
  explicit EdgeIndex(std::span<const PointTriangle> triangles);
  /// Returns the triangle with the directed edge from a to b, or kNull.
  std::uint32_t find(std::uint32_t a, std::uint32_t b) const;

 private:
  struct Edge {
    std::uint64_t key;
    std::uint32_t triangle = kNull;  ///< kNull: the place is empty
  };
  std::uint64_t place_of(std::uint64_t key) const;

  std::vector<Edge> edges_;  ///< a hash table, at most half full
};

/// Everything that can be computed about a cap before it is applied to the front. It remains valid when other
/// caps are applied, if they share no vertex with the triangles that this one covers.
struct Sheet {
  /// Corners from this number on are the cap's new points, in order.
  static constexpr FrontMesh::Corner kNewPoint = 1u << 31;

  std::vector<FrontMesh::Slot> removed;  ///< ascending, so that the triangles of one polygon are adjacent
  std::vector<PointTriangle> added;      ///< corners are vertices of the front
  std::vector<Eigen::Vector3d> new_points;
  RegionPieces pieces;
  /// (|added|) the triangle across each edge: another added one or, at the boundary, the neighbour of a
  /// removed one.
  struct Beyond {
    std::uint32_t added = kNull, removed = kNull;
  };
  std::vector<std::array<Beyond, 3>> beyond;
};

/// Computes the regions of a sheet and the neighbours across its edges, from the triangles removed and added,
/// which must have the same boundary.
void work_out(const FrontMesh& front, Sheet& sheet);

/// Replaces the removed triangles of the front by the added ones. These become pseudo faces of `component`,
/// with regions of this layer behind them and, for now, the outside in front; the faces that they cover get
/// these regions in front. Returns the new slots. Reports the regions to `probe`, if not null.
std::vector<FrontMesh::Slot> cover(FrontMesh& front, ComplexBuilder& complex, const Sheet& sheet,
                                   std::uint16_t layer, std::uint32_t component, ConstructProbe* probe);

}  // namespace lrb::construct
