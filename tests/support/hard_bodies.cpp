#include "tests/support/hard_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"

namespace lrb::hard {
namespace {

using Eigen::Vector3d;

double angle(std::uint32_t i, std::uint32_t n) {
  return 2 * std::numbers::pi * i / n;
}

/// A point of the unit circle, times `radius`.
Vector3d on_circle(std::uint32_t i, std::uint32_t n, double radius = 1, double z = 0) {
  return {radius * std::cos(angle(i, n)), radius * std::sin(angle(i, n)), z};
}

/// Vertices 0 .. n - 1 below, n .. 2n - 1 above them.
Mesh prism(const std::vector<Vector3d>& below, const std::vector<Vector3d>& above) {
  Mesh mesh = test::prism(std::vector<Eigen::Vector2d>(below.size()));
  std::copy(above.begin(), above.end(), std::copy(below.begin(), below.end(), mesh.vertices.begin()));
  return mesh;
}

Mesh upright_prism(const std::vector<Vector3d>& below) {
  std::vector<Vector3d> above = below;
  for (Vector3d& p : above) p.z() = 1;
  return prism(below, above);
}

/// The ring's vertices, and triangles from them to an apex: seen from above if `up`.
void add_fan(Mesh& mesh, std::uint32_t n, const Vector3d& apex, bool up) {
  const auto tip = static_cast<VertexId>(mesh.vertices.size());
  mesh.vertices.push_back(apex);
  for (std::uint32_t i = 0; i < n; ++i) {
    const VertexId a(i), b((i + 1) % n);
    mesh.add_face(up ? std::array{a, b, tip} : std::array{b, a, tip});
  }
}

Mesh ring(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) mesh.vertices.push_back(on_circle(i, n));
  return mesh;
}

}  // namespace

Mesh rock(std::uint32_t level) {
  return shapes::bumpy_sphere(static_cast<int>(level), 1, 0.2);
}

Mesh drum(std::uint32_t n) {
  return upright_prism(ring(n).vertices);
}

Mesh cog(std::uint32_t n) {
  std::vector<Vector3d> below;
  for (std::uint32_t i = 0; i < n; ++i) below.push_back(on_circle(i, n, i % 2 == 0 ? 1 : 0.9));
  return upright_prism(below);
}

Mesh fine_box(std::uint32_t n) {
  const std::uint32_t side = n / 4;
  std::vector<Vector3d> below;
  const std::array<Vector3d, 5> corners = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}};
  for (std::size_t s = 0; s < 4; ++s)
    for (std::uint32_t i = 0; i < side; ++i)
      below.push_back(corners[s] + (corners[s + 1] - corners[s]) * (static_cast<double>(i) / side));
  return upright_prism(below);
}

Mesh cone(std::uint32_t n) {
  Mesh mesh = ring(n);
  add_fan(mesh, n, {0, 0, 1}, true);
  std::vector<VertexId> base(n);
  for (std::uint32_t i = 0; i < n; ++i) base[i] = VertexId(n - 1 - i);
  mesh.add_face(base);
  return mesh;
}

Mesh bipyramid(std::uint32_t n) {
  Mesh mesh = ring(n);
  add_fan(mesh, n, {0, 0, 1}, true);
  add_fan(mesh, n, {0, 0, -1}, false);
  return mesh;
}

Mesh crown(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i)
    mesh.vertices.push_back(on_circle(i, n, 1 + 0.2 * std::sin(7 * angle(i, n)), 0.1 * (i % 3)));
  add_fan(mesh, n, {0, 0, 1}, true);
  add_fan(mesh, n, {0, 0, -1}, false);
  return mesh;
}

Mesh fan_disk(std::uint32_t n) {
  Mesh mesh = ring(n);
  add_fan(mesh, n, {0, 0, 0}, true);
  return mesh;
}

Mesh frustum(std::uint32_t n) {
  std::vector<Vector3d> above;
  for (std::uint32_t i = 0; i < n; ++i) above.push_back(on_circle(i, n, 1.0 / 16, 1));
  return prism(ring(n).vertices, above);
}

Mesh nested(std::uint32_t depth) {
  std::vector<Mesh> shells;
  for (std::uint32_t i = 0; i < depth; ++i) {
    Mesh shell = shapes::icosphere(1, std::pow(0.9, i));
    shells.push_back(i % 2 == 0 ? std::move(shell) : shapes::turned_inside_out(std::move(shell)));
  }
  return shapes::several(shells);
}

Mesh pieces(std::uint32_t count) {
  std::vector<Mesh> balls;
  for (std::uint32_t i = 0; i < count; ++i)
    balls.push_back(shapes::translated(shapes::bumpy_sphere(2, i + 1), {2.5 * i, 0, 0}));
  return shapes::several(balls);
}

Mesh tiles(std::uint32_t n) {
  return shapes::voxels(
      static_cast<int>(n), static_cast<int>(n), 1, [](int, int, int) { return true; }, true);
}

}  // namespace lrb::hard
