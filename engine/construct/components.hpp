#pragma once
/// Finds which of a body's surfaces bound voids, and what lies in these.

#include <cstdint>
#include <vector>

#include "engine/construct/hull_mesh.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// Returns the faces that lie within another component, of a mesh whose components cross. `meeting`: the
/// faces that meet others in more than they share, ascending; they are not among those returned. `hull`: the
/// mesh itself.
///
/// A cap over them would stand inside the other component, where no hull is in its way any more, and could
/// pass through what lies under that component's caps.
std::vector<FaceId> find_buried(const Mesh& mesh, const HullMesh& hull, const std::vector<FaceId>& meeting);

/// Returns the void in front of each component of the mesh's surface: (components) itself for a void, kNull
/// where the outside is. `hull` is the mesh's own surface still. Exact, except that a component that
/// crosses a void's wall is placed by one of its vertices.
std::vector<std::uint32_t> find_nesting(const Mesh& mesh, const HullMesh& hull);

}  // namespace lrb::construct
