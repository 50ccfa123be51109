#pragma once
/// Pictures of a body: its wrappers, regions of it, and the faults of its mesh.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/pictures/panel.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb::pictures {

// Contact sheets: panels (a), (b), ... of the look's size, in pixels of the file, seen from its first view.

/// Draws a body, some of its intermediate wrappers, and its outermost wrapper.
render::Image body_sheet(const LrbRep& rep, const pictures::Look& look);

/// The size of a panel unless one is requested.
inline constexpr int kBodySheetWidth = 640, kBodySheetHeight = 520;

/// A region to draw, and its caption.
struct ShownRegion {
  RegionId region = 0;
  std::string caption;
};

/// Draws regions of a body: in panel (a) the body's real faces, coloured by a value; then a close-up of each
/// region from the direction that its lids face, with its lids translucent over its floor, and the rest as a
/// ghost. `values`: (|real faces|); `name`: of the value.
render::Image region_sheet(const LrbRep& rep, std::span<const double> values, const std::string& name,
                           std::span<const ShownRegion> regions, const pictures::Look& look);

/// Returns the mean direction of a region's lids; zero if they face nearly all directions, and in 2D.
Eigen::Vector3d outlook(const LrbRep& rep, RegionId r);

/// Describes regions: a single one by its layer, lids, floor, parent and neighbours, several by their
/// numbers. `owner`: text after a region's number, such as " of A".
std::string region_text(const LrbRep& rep, std::span<const RegionId> regions, const std::string& owner);

// Findings.

/// A mesh and its faults.
struct FaultyMesh {
  const Mesh& mesh;
  const MeshReport& report;
  const std::vector<BoundaryLoop>& loops;
  std::vector<std::array<Eigen::Vector3d, 2>> crossings = {};  ///< segments in which faces intersect
};

/// Draws a mesh's findings: the whole mesh in panel (a), from the look's first view, then a close-up of the
/// first finding of each kind. All open edges are drawn; the close-up shows the longest loop. `look`: in
/// pixels of the file; height 0: as required. Returns nullopt if no finding has a position.
std::optional<render::Image> picture_of(const FaultyMesh& faulty, const pictures::Look& look);

/// The width of the picture unless one is requested.
inline constexpr int kFindingsSheetWidth = 1600;

}  // namespace lrb::pictures
