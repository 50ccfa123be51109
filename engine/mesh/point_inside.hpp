#pragma once

#include <span>

#include "engine/mesh/mesh.hpp"

namespace lrb {

enum class PointSide { outside, inside, on_surface };

/// Tells where a point lies relative to a closed set of faces (fans of triangles; 2D: segments), by the
/// parity of an exact ray.
PointSide point_side(const Mesh& mesh, std::span<const FaceId> faces, const Eigen::Vector3d& p);

}  // namespace lrb
