#pragma once

#include "engine/mesh/mesh.hpp"

namespace lrb::resolutions {

/// Replaces each triangle by four and smooths the surface: Loop's scheme ("Smooth Subdivision Surfaces Based
/// on Triangles", 1987) with Warren's weights. `mesh` must consist of triangles and be closed, with two faces
/// at every edge. New vertices follow the old ones. Where parts of the surface are close to each other the
/// result may intersect itself, which check_mesh() finds.
Mesh subdivide(const Mesh& mesh);

}  // namespace lrb::resolutions
