#pragma once
/// Puts a new sheet on the hull: into the complex with its regions, and into the hull in place of what it
/// covers.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/cap_surface.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/hull_mesh.hpp"
#include <lrbscope/build.hpp>

namespace lrb::construct {

// Splits the space between two sheets of surface into regions.

/// A triangle: its corners as indices of points, counter-clockwise seen from outside.
using PointTriangle = std::array<std::uint32_t, 3>;

/// Tells which piece each triangle bounds: pieces 0 .. count - 1.
struct RegionPieces {
  std::uint32_t count = 0;
  std::uint32_t merged = 0;             ///< pieces without volume that became part of another one...
  std::uint32_t into = 0;               ///< ...which is this
  std::vector<std::uint32_t> of_old;    ///< (|old|)
  std::vector<std::uint32_t> of_added;  ///< (|added|)
};

/// Splits the space between the sheets `old` and `added`, which lies in front of it, into pieces. (Triangles
/// that are in both sheets are in neither list.) `old_face`: triangles of one polygon have the same entry and
/// are neighbours in the list. Pieces are connected over edges; where the sheets touch in an edge, the space
/// to its left and the space to its right are different pieces. A piece without volume is the inner shell of
/// another one: it is joined to the largest.
RegionPieces split_region(std::span<const PointTriangle> old, std::span<const std::uint32_t> old_face,
                          std::span<const PointTriangle> added, std::span<const Eigen::Vector3d> points);

/// Directed edges of triangles, to be looked up.
class EdgeIndex {
 public:
  explicit EdgeIndex(std::span<const PointTriangle> triangles);
  /// Returns the triangle in which an edge runs from a to b, or kNull.
  std::uint32_t find(std::uint32_t a, std::uint32_t b) const;

 private:
  struct Edge {
    std::uint64_t key;
    std::uint32_t triangle;
  };
  std::vector<Edge> edges_;
};

/// Everything that can be computed about a sheet before it is put on the hull. It stays valid when other
/// sheets are put on, as long as they have no vertex in common with what this one covers.
struct Sheet {
  /// Corners from this number on are the sheet's own new points, in order.
  static constexpr HullMesh::Corner kNewPoint = 1u << 31;

  std::vector<HullMesh::Slot> removed;  ///< ascending: triangles of one polygon are neighbours
  std::vector<HullMesh::Slot> kept;     ///< for a patch: the triangles that its cap keeps
  std::vector<PointTriangle> added;     ///< corners are the hull's vertices
  std::vector<Eigen::Vector3d> new_points;
  /// (|new_points|), (|added|) how far they are off the body, see HullMesh; empty if nobody measured it.
  std::vector<double> new_off, added_extra;
  RegionPieces pieces;
  /// (|added|) what lies beyond each edge: another added triangle or, at the boundary, what lay beyond a
  /// removed one.
  struct Beyond {
    std::uint32_t added = kNull, removed = kNull;
  };
  std::vector<std::array<Beyond, 3>> beyond;
};

/// Returns the sheet that covers the triangles `removed` with `added`; they have the same boundary.
Sheet make_sheet(const HullMesh& hull, std::span<const HullMesh::Slot> removed,
                 std::span<const PointTriangle> added);

/// Returns the sheet that covers a patch with its finished cap; triangles that the cap has kept stay.
Sheet make_sheet(const HullMesh& hull, const Patch& patch, const CapSurface& cap);

/// Takes the sheet's removed triangles out of the hull and puts the added ones in their place. These become
/// pseudo faces of `component` with regions of this layer behind them and, for now, the outside in front; the
/// faces that they cover get those regions in front. Returns the new slots. Tells `probe` of the regions, if
/// there is one.
std::vector<HullMesh::Slot> cover(HullMesh& hull, ComplexBuilder& complex, const Sheet& sheet,
                                  std::uint16_t layer, std::uint32_t component, ConstructProbe* probe);

}  // namespace lrb::construct
