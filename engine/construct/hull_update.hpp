#pragma once
/// Puts a new sheet on the hull: into the complex with its regions, and into the hull in place of what it
/// covers.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/construct/cap_surface.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/hull_mesh.hpp"
#include "engine/construct/region_split.hpp"
#include <lrbscope/build.hpp>

namespace lrb::construct {

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
