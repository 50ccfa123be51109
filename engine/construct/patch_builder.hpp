#pragma once
/// The builder for bodies in space: patch caps on progressive hulls.
///
/// It works on the *current hull*, at first the mesh itself. In each pass the hull is covered with patches,
/// disks of a few dozen triangles (patch_grow.hpp); each is simplified outward into a cap on the same ring
/// (patch_cap.hpp); the space between is a region, its floor the patch and its lids the cap
/// (region_split.hpp); the caps become part of the hull of the next pass. A cap stands only if it is proved,
/// exactly, to meet nothing else (embed_check.hpp): then the new hull is embedded again and encloses the old
/// one, and so all faces of the complex meet only in what they share. When passes no longer help, each
/// component of the hull is simplified as a whole, and at last one wrapper of few faces is put around all of
/// them (closing.hpp).

#include "engine/construct/build.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Builds an LRB-rep from a 3D mesh that is MeshReport::buildable() and not inside out. `meeting`: the mesh's
/// faces that meet others in more than they share, ascending; only the outermost region abstracts from these.
LrbData build_by_patches(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options);

}  // namespace lrb::construct
