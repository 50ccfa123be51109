#pragma once
/// The builder for bodies in the plane: the idea of patch_builder.hpp, one dimension down.
///
/// A patch is a chain of segments, and its ring is the chain's two ends. The cap is the chord between them
/// where the chain lies behind it, else two segments whose common vertex lies in front of all the chain's
/// lines.

#include "engine/construct/build.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Builds an LRB-rep from a 2D mesh that is MeshReport::buildable() and not inside out. `meeting`: the mesh's
/// faces that meet others in more than they share, ascending.
LrbData build_by_chains(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options);

}  // namespace lrb::construct
