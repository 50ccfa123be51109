#pragma once
/// Finds which of a body's surfaces bound voids, and what lies in these.

#include <cstdint>
#include <vector>

#include "engine/construct/hull_mesh.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Returns the void in front of each component of the mesh's surface: (components) itself for a void, kNull
/// where the outside is. `hull` is the mesh's own surface still. Exact, except that a component that
/// crosses a void's wall is placed by one of its vertices.
std::vector<std::uint32_t> find_nesting(const Mesh& mesh, const HullMesh& hull);

}  // namespace lrb::construct
