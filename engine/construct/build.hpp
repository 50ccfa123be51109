#pragma once
/// Builds an LRB-rep from a mesh.

#include <cstdint>
#include <functional>

#include "engine/construct/construct_probe.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/mesh/checked_mesh.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb {

struct BuildOptions {
  /// Number of interior vertices that a patch aims at: small makes the paper's recursion cheap, large makes
  /// the structure small.
  std::uint32_t patch_interior = 16;
  std::uint32_t max_outer_faces = 20;  ///< number of faces to aim for in the outermost wrapper
  /// Builds a small structure (about 1.5 faces per real face) in place of wrappers that fit (about 2).
  bool lean = false;
  std::uint64_t seed = 1;  ///< seeds the order in which patches grow
  unsigned threads = 1;    ///< 0: as many as the machine runs at once. The result does not depend on it
  /// Called after each pass with the pass's number and the number of faces of the hull. May be empty.
  std::function<void(std::uint32_t pass, std::uint32_t hull_faces)> progress;
  ConstructProbe* probe = nullptr;  ///< is told everything that happens; null: nobody. Must outlive the build
};

/// Builds by patch caps on progressive hulls (patch_builder.hpp); 2D meshes go through chain_builder.hpp. The
/// mesh must be closed, manifold and oriented, with the solid behind its faces, as MeshReport::buildable()
/// says: InputError names the offenders otherwise. A body that is inside out is turned by
/// CheckedMesh::turn_outward(). Deterministic for a seed, on any number of threads.
LrbRep build_lrb(const CheckedMesh& mesh, const BuildOptions& options = {});

/// Checks the mesh first, then does the same.
LrbRep build_lrb(const Mesh& mesh, const BuildOptions& options = {});

}  // namespace lrb
