#pragma once

#include "engine/mesh/mesh.hpp"

namespace lrb::resolutions {

/// The surface with four triangles for each of its own, smoothed: Loop's scheme ("Smooth Subdivision Surfaces
/// Based on Triangles", 1987) with Warren's weights. `mesh`: triangles, closed, every edge with two faces.
/// New vertices follow the old ones. Where parts of the surface come near each other it may come to meet
/// itself: check_mesh() tells.
Mesh subdivide(const Mesh& mesh);

}  // namespace lrb::resolutions
