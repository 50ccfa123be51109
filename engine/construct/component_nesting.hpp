#pragma once
/// Which of a body's surfaces bound voids, and what lies in them.

#include <cstdint>
#include <vector>

#include "engine/construct/hull_mesh.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// What lies in front of a component of the mesh's surface: the outside, or a void.
struct ComponentNesting {
  std::vector<bool> is_void;  ///< (components) it faces inward
  std::vector<std::uint32_t>
      home;  ///< (components) the void in front of it: itself for a void; kNull: the outside
};

/// `hull` is the mesh's own surface still. Exact, but that components which cross a void's wall count as in
/// it or not by a vertex.
ComponentNesting find_nesting(const Mesh& mesh, const HullMesh& hull);

}  // namespace lrb::construct
