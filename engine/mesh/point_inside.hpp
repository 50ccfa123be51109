#pragma once

#include <span>

#include "engine/mesh/mesh.hpp"

namespace lrb {

struct PointSide {
  bool inside = false;      ///< a ray from the point leaves the surface an odd number of times
  bool on_surface = false;  ///< the point lies on a face; `inside` is then that of a point infinitely near
};

/// Where a point lies to a closed set of faces (fans of triangles; 2D: segments). Exact: the ray goes in the
/// direction of +x from p + (e^3, e, e^2) for an infinitely small e (2D: p + (e^2, e)), so that it never
/// meets an edge, and every sign has a definite value (simulation of simplicity, Edelsbrunner and Muecke
/// 1990).
PointSide point_side(const Mesh& mesh, std::span<const FaceId> faces, const Eigen::Vector3d& p);

}  // namespace lrb
