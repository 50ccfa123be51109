#pragma once

#include <string>
#include <vector>

#include "render/pictures/frame_spec.hpp"
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb::run {

/// A mesh and what is wrong with it.
struct FaultyMesh {
  const Mesh& mesh;
  const MeshReport& report;
  const std::vector<BoundaryLoop>& loops;
};

/// Draws a mesh's findings: the whole mesh in panel (a), the first offender of each kind close up in a panel
/// each. Of open edges all are drawn, and the longest loop close up. `frames` says how large the whole is to
/// be (height 0: as it needs) and, by its first view, from where the whole is seen. Returns false, and writes
/// nothing, if there is nothing to point at.
bool draw_findings(const FaultyMesh& faulty, const std::string& path, const render::FrameSpec& frames);

/// The width of the picture unless one is asked for.
inline constexpr int kFindingsSheetWidth = 1600;

}  // namespace lrb::run
