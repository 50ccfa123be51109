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

/// Draws a mesh's findings: the whole mesh in panel (a), seen from the look's first view, then the first
/// offender of each kind close up. Open edges are all drawn, and the longest loop close up. `look`: in pixels
/// of the file; height 0: as high as needed. Returns nullopt if no finding has a position.
std::optional<render::Image> picture_of(const FaultyMesh& faulty, const render::Look& look);

/// The width of the picture unless one is requested.
inline constexpr int kFindingsSheetWidth = 1600;

}  // namespace lrb::run
