#pragma once

#include <cstdint>

#include "engine/mesh/mesh.hpp"

namespace lrb {

/// What join_corners() has done.
struct JoinedCorners {
  std::uint32_t before = 0, after = 0;            ///< vertices that faces use
  std::uint32_t open_before = 0, open_after = 0;  ///< open edges (2D: loose ends)
  bool any() const { return after < before; }
};

/// Joins vertices in exactly the same place (0 and -0 count as the same) where the surface is open: many
/// files give each face vertices of its own, so that every edge is open although nothing gapes. Faces keep
/// their numbers, and vertices theirs; those that no face uses any more are listed in Mesh::joined.
///
/// Only the ends of open edges (2D: loose ends) are joined, and only with those of open edges in the same
/// place. So a piece that is closed is never touched: two bodies that are kept apart though they touch in a
/// corner or along an edge stay as they are, and so do surfaces that are open elsewhere and pass through one
/// place. Edges that fit one to one, in opposite directions, are joined first, again and again: where two
/// boxes of loose faces touch along an edge, what their other edges tell keeps them two boxes. What is then
/// still open and lies in one place is joined as well; it becomes closed, or the fault that it is (an edge
/// with more than two faces, faces that contradict each other).
JoinedCorners join_corners(Mesh& mesh);

}  // namespace lrb
