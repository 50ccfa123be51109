#pragma once

#include <array>
#include <cmath>
#include <functional>

#include <lrbscope/mesh.hpp>

namespace lrb::test {

/// Returns a ball of quads with triangles at its poles; `radius` is called for each vertex in turn. Where
/// radii differ the quads fold.
inline Mesh quad_ball(std::uint32_t slices, std::uint32_t rings, const std::function<double()>& radius) {
  constexpr double kHalfTurn = 3.141592653589793;
  Mesh mesh;
  const auto add = [&](double latitude, double turn) {
    mesh.vertices.push_back(radius() * Eigen::Vector3d{std::cos(latitude) * std::cos(turn),
                                                       std::cos(latitude) * std::sin(turn),
                                                       std::sin(latitude)});
  };
  for (std::uint32_t r = 1; r <= rings; ++r)
    for (std::uint32_t s = 0; s < slices; ++s)
      add(kHalfTurn * (r / (rings + 1.0) - 0.5), 2 * kHalfTurn * s / slices);
  add(-kHalfTurn / 2, 0);
  add(kHalfTurn / 2, 0);
  const std::uint32_t south = slices * rings, last = slices * (rings - 1);
  for (std::uint32_t s = 0; s < slices; ++s) {
    const std::uint32_t t = (s + 1) % slices;
    mesh.add_face(std::array{VertexId(south), VertexId(t), VertexId(s)});
    mesh.add_face(std::array{VertexId(south + 1), VertexId(last + s), VertexId(last + t)});
    for (std::uint32_t r = 0; r < last; r += slices)
      mesh.add_face(
          std::array{VertexId(r + s), VertexId(r + t), VertexId(r + slices + t), VertexId(r + slices + s)});
  }
  return mesh;
}

}  // namespace lrb::test
