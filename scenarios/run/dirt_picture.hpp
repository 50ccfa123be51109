#pragma once

#include <string>

#include "engine/mesh/mesh_check.hpp"

namespace lrb::run {

/// Draws a mesh's findings: the whole mesh in panel (a), the first offender of each kind close up in a panel
/// each. Returns false, and writes nothing, if there is nothing to point at.
bool draw_dirt(const Mesh& mesh, const MeshReport& report, const std::string& path);

}  // namespace lrb::run
