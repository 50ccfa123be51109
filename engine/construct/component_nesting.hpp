#pragma once
/// Finds which of a body's surfaces bound voids, and what lies in these.

#include <cstdint>
#include <vector>

#include "engine/construct/hull_mesh.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Tells, for each component of the mesh's surface, what lies in front of it: the outside, or a void.
struct ComponentNesting {
  std::vector<bool> is_void;  ///< (components) true if it faces inward
  std::vector<std::uint32_t>
      home;  ///< (components) the void in front of it: itself for a void; kNull: the outside
};

/// Finds the nesting. `hull` must still be the mesh's own surface. Exact, except that a component which
/// crosses the wall of a void counts as inside it or not by one of its vertices.
ComponentNesting find_nesting(const Mesh& mesh, const HullMesh& hull);

}  // namespace lrb::construct
