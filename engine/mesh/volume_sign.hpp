#pragma once

#include <span>

#include "engine/mesh/mesh.hpp"

namespace lrb {

/// Returns the sign (-1, 0, +1) of the volume behind a closed set of faces, each taken as its fan (2D: of the
/// area to the left of a closed set of segments): +1 if they face outward. Exact; coordinates must be finite.
int volume_sign(const Mesh& mesh, std::span<const FaceId> faces);

}  // namespace lrb
