#pragma once
/// Draw lists made by hand.

#include <array>
#include <vector>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/render/draw_list.hpp>

namespace lrb::test {

using Triangles = std::vector<std::array<Eigen::Vector3d, 3>>;

/// The triangles of a mesh.
inline Triangles triangles_of(const Mesh& mesh) {
  Triangles out;
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    out.push_back(
        {mesh.vertices[mesh.face(f)[0]], mesh.vertices[mesh.face(f)[1]], mesh.vertices[mesh.face(f)[2]]});
  return out;
}

/// A sphere of 20 * 4^levels triangles.
inline Triangles sphere_triangles(int levels, double radius = 1, const Eigen::Vector3d& centre = {0, 0, 0}) {
  return triangles_of(shapes::icosphere(levels, radius, centre));
}

inline Triangles box_triangles(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return triangles_of(shapes::box(low, high));
}

inline void add(render::DrawList& list, const Triangles& triangles, const render::DrawTriangle& like,
                std::uint32_t first_id = 0) {
  for (const auto& x : triangles) {
    render::DrawTriangle t = like;
    t.x = x;
    t.id = first_id++;
    list.triangles.push_back(t);
  }
}

}  // namespace lrb::test
