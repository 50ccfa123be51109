#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb {

/// Returns the wrongly oriented closed components, as lists of their faces, in the order of the first face. A
/// component inside an even number of others bounds a solid and must face outward; one inside an odd number
/// is a void and must face inward. Inside means entirely inside: components that cross each other are not
/// nested. Exact, except for components whose tried vertices are all on another's surface.
std::vector<std::vector<FaceId>> wrongly_facing_components(const Mesh& mesh, const std::vector<FaceUse>& use,
                                                           const SurfaceTopology& topology);

/// Returns the sign (-1, 0, +1) of the volume behind a closed set of faces, each taken as its fan (2D: of the
/// area left of a closed set of segments): +1 if they face outward. Exact; coordinates must be finite.
int volume_sign(const Mesh& mesh, std::span<const FaceId> faces);

}  // namespace lrb
