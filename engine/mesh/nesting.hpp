#pragma once

#include <cstdint>
#include <vector>

#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/mesh.hpp"
#include "engine/mesh/surface_topology.hpp"

namespace lrb {

/// Returns the closed components that face the wrong way, as lists of their faces, in order of first face. A
/// component inside an even number of others bounds a solid and must face outward; one inside an odd number
/// is a void and must face inward. Inside means wholly inside: components that cross each other are not
/// nested. Exact, except for components all of whose tried vertices lie on another's surface.
std::vector<std::vector<FaceId>> wrongly_facing_components(const Mesh& mesh, const std::vector<FaceUse>& use,
                                                           const SurfaceTopology& topology);

}  // namespace lrb
