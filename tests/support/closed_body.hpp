#pragma once

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::test {

/// Returns a mesh with each coordinate multiplied by one of `by`.
inline Mesh stretched(Mesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& v : mesh.vertices) v = v.cwiseProduct(by);
  return mesh;
}

/// Returns a closed body without regions: `size` times the mesh.
inline LrbRep closed(const Mesh& mesh, double size = 1) {
  return LrbRep::without_regions(size == 1 ? mesh : shapes::scaled(mesh, size), true, false);
}

}  // namespace lrb::test
