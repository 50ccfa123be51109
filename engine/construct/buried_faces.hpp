#pragma once

#include <vector>

#include "engine/construct/hull_mesh.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Returns the faces that lie within another component, of a mesh whose components cross. `meeting`: the
/// faces that meet others in more than they share, ascending; they are not among those returned. `hull`: the
/// mesh itself.
///
/// A cap over them would stand inside the other component, where no hull is in its way any more, and could
/// pass through what lies under that component's caps.
std::vector<FaceId> find_buried(const Mesh& mesh, const HullMesh& hull, const std::vector<FaceId>& meeting);

}  // namespace lrb::construct
