#pragma once
/// The space between a patch and its cap, as regions.

#include <cstdint>
#include <vector>

#include "engine/build/cap_surface.hpp"
#include "engine/build/hull_mesh.hpp"
#include "engine/build/patch_grow.hpp"

namespace lrb {

/// Which piece each triangle bounds. Triangles that cap and patch have in common bound none.
struct RegionPieces {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> of_old;  ///< (|Patch::slots|), kNull: the triangle stays
  std::vector<std::uint32_t> of_new;  ///< (|cap faces|), kNull: the triangle stays, or is not in use
};

/// Pieces hang together over edges. Where patch and cap touch in an edge the space to its left and to its right are
/// different pieces. The triangles of one polygon are kept in one piece. A piece without volume in front of it is the
/// inner shell of another one: it is joined to the largest.
RegionPieces split_region(const HullMesh& hull, const Patch& patch, const CapSurface& cap);

}  // namespace lrb
