#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

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

/// Returns triangles (2D: segments) between points of a grid: many are degenerate, touch, overlap, or are
/// equally far from each other. With `points` > 0, the faces share that many vertices, so that many also have
/// common corners and edges.
inline Mesh grid_soup(shapes::RandomEngine& random, std::uint32_t faces, int dim = 3,
                      std::uint32_t points = 0) {
  Mesh mesh;
  mesh.dim = dim;
  const auto n = static_cast<std::uint32_t>(dim);
  const auto coordinate = [&] { return std::floor(shapes::uniform(random, 0, 4)); };
  const auto add_point = [&] {
    const double x = coordinate(), y = coordinate();
    mesh.vertices.push_back({x, y, dim == 3 ? coordinate() : 0});
  };
  for (std::uint32_t i = 0; i < points; ++i) add_point();
  for (std::uint32_t f = 0; f < faces; ++f) {
    std::vector<VertexId> corners;
    while (corners.size() < n) {
      VertexId v(static_cast<std::uint32_t>(mesh.vertices.size()));
      if (points == 0)
        add_point();
      else
        v = VertexId(static_cast<std::uint32_t>(random() % points));
      if (std::find(corners.begin(), corners.end(), v) == corners.end()) corners.push_back(v);
    }
    mesh.add_face(corners);
  }
  return mesh;
}

}  // namespace lrb::test
