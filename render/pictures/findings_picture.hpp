#pragma once

#include <optional>
#include <vector>

#include "render/pictures/panel.hpp"
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb::run {

/// A mesh and its faults.
struct FaultyMesh {
  const Mesh& mesh;
  const MeshReport& report;
  const std::vector<BoundaryLoop>& loops;
};

/// Draws a mesh's findings: the whole mesh in panel (a), from the look's first view, then a close-up of the
/// first finding of each kind. All open edges are drawn; the close-up shows the longest loop. `look`: in
/// pixels of the file; height 0: as required. Returns nullopt if no finding has a position.
std::optional<render::Image> picture_of(const FaultyMesh& faulty, const render::Look& look);

/// The width of the picture unless one is requested.
inline constexpr int kFindingsSheetWidth = 1600;

}  // namespace lrb::run
