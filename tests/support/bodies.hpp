#pragma once
/// Bodies and motions that several tests draw, beside those of shapes.hpp and hard_bodies.hpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include <Eigen/Geometry>

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

/// Returns a body of faces alone that bound no solid.
inline LrbRep open_body(const Mesh& mesh) {
  return LrbRep::without_regions(mesh, false, false);
}

/// Returns the signed volume behind the faces of a mesh.
inline double volume(const Mesh& mesh) {
  double six = 0;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto c = mesh.face(f);
    for (std::size_t i = 1; i + 1 < c.size(); ++i)
      six += mesh.vertices[c[0]].dot(mesh.vertices[c[i]].cross(mesh.vertices[c[i + 1]]));
  }
  return six / 6;
}

/// Returns a sheet of n x n quads in the plane z = 0.
inline Mesh sheet(std::uint32_t n, const Eigen::Vector2d& low = {0, 0},
                  const Eigen::Vector2d& high = {1, 1}) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      mesh.vertices.push_back(
          {low.x() + (high.x() - low.x()) * i / n, low.y() + (high.y() - low.y()) * j / n, 0});
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t v = j * (n + 1) + i;
      mesh.add_face(std::array{VertexId(v), VertexId(v + 1), VertexId(v + n + 2), VertexId(v + n + 1)});
    }
  return mesh;
}

/// Returns the prism over an outline, from z = 0 to 1: two polygons and a quad for each side.
inline Mesh prism(const std::vector<Eigen::Vector2d>& outline) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, 1.0})
    for (const Eigen::Vector2d& x : outline) mesh.vertices.push_back({x.x(), x.y(), z});
  std::vector<VertexId> low, high;
  for (std::uint32_t i = 0; i < n; ++i) low.emplace_back(n - 1 - i), high.emplace_back(n + i);
  mesh.add_face(low);
  mesh.add_face(high);
  for (std::uint32_t i = 0, j = 1; i < n; ++i, j = (i + 1) % n)
    mesh.add_face(std::array{VertexId(i), VertexId(j), VertexId(n + j), VertexId(n + i)});
  return mesh;
}

/// Returns a U profile of size 5 x 4 x 1 with walls of 1. Its ends are polygons from the corner `first`.
inline Mesh u_profile(std::ptrdiff_t first = 0) {
  std::vector<Eigen::Vector2d> u = {{0, 0}, {5, 0}, {5, 4}, {4, 4}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
  std::rotate(u.begin(), u.begin() + first, u.end());
  return prism(u);
}

/// Returns a plate of size 6 x 6 x 1 with a hole of 2 x 2. Its sides are outlines with a bridge to the hole.
inline Mesh plate_with_hole() {
  Mesh mesh =
      shapes::several({prism({{0, 0}, {6, 0}, {6, 6}, {0, 6}}), prism({{2, 2}, {2, 4}, {4, 4}, {4, 2}})});
  Mesh out;
  out.vertices = mesh.vertices;
  const auto add = [&](std::initializer_list<std::uint32_t> corners) {
    const std::vector<VertexId> ids(corners.begin(), corners.end());
    out.add_face(ids);
  };
  add({0, 8, 11, 10, 9, 8, 0, 3, 2, 1});
  add({4, 5, 6, 7, 4, 12, 13, 14, 15, 12});
  for (const std::uint32_t f : {2, 3, 4, 5, 8, 9, 10, 11}) out.add_face(mesh.face(FaceId(f)));
  return out;
}

/// Adds a triangle (2D: a segment) with corners of its own.
inline void add_loose(Mesh& mesh, const std::vector<Eigen::Vector3d>& corners) {
  std::vector<VertexId> ids;
  for (const Eigen::Vector3d& x : corners) {
    ids.emplace_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back(x);
  }
  mesh.add_face(ids);
}

/// Returns long thin triangles, two in three of them without area.
inline Mesh loose_needles(shapes::RandomEngine& random) {
  Mesh mesh;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d p = shapes::random_direction(random), d = shapes::random_direction(random);
    add_loose(mesh, {p, p + d,
                     i % 3 == 0   ? p
                     : i % 3 == 1 ? Eigen::Vector3d(p + d)
                                  : Eigen::Vector3d(p + 1e-6 * d.cross(p))});
  }
  return mesh;
}

/// Calls check(a, b, pose of B, number) for pairs of bodies in the plane, three poses each, and of loose
/// needles, `loose` poses.
inline void for_flat_and_loose(shapes::RandomEngine& random, int loose, const auto& check) {
  const LrbRep flat[] = {closed(shapes::gear(6)), closed(shapes::star(5)), closed(shapes::ring_2d(8))};
  for (const LrbRep& a : flat)
    for (const LrbRep& b : flat)
      for (int i = 0; i < 3; ++i) {
        const double x = shapes::uniform(random, 0, 3), y = shapes::uniform(random, 0, 1);
        check(a, b, Pose::rotation({0, 0, 1}, shapes::uniform(random, 0, 6), {x, y, 0}), i);
      }
  const LrbRep needles = open_body(loose_needles(random));
  for (int i = 0; i < loose; ++i)
    check(needles, needles, Pose{shapes::random_rotation(random), 0.1 * shapes::random_direction(random)}, i);
}

/// Returns the mesh without its last face.
inline Mesh without_last_face(Mesh mesh) {
  mesh.face_vertices.resize(mesh.face_offsets[mesh.face_count() - 1]);
  mesh.face_offsets.pop_back();
  return mesh;
}

/// Returns the mesh with each coordinate changed by up to `by`.
inline Mesh shaken(Mesh mesh, double by, std::uint64_t seed) {
  shapes::RandomEngine random(seed);
  for (Eigen::Vector3d& v : mesh.vertices)
    for (double& x : v) x += by * shapes::uniform(random, -1, 1);
  return mesh;
}

/// Returns the direction or the point in the plane z = 0 for a 2D body, else as it is.
inline Eigen::Vector3d in_space(Eigen::Vector3d x, int dim) {
  if (dim == 2) x.z() = 0;
  return x;
}

/// Moves a body by up to `shift` and turns it by up to `turn` radians; in the plane, if it is 2D.
inline Pose nudged(shapes::RandomEngine& random, const Pose& pose, double turn, double shift, int dim) {
  const Eigen::Vector3d axis = dim == 2 ? Eigen::Vector3d::UnitZ() : shapes::random_direction(random);
  const Eigen::Matrix3d r = deterministic::rotation(axis, shapes::uniform(random, -turn, turn));
  return {r * pose.r,
          pose.t + shapes::uniform(random, 0, shift) * in_space(shapes::random_direction(random), dim)};
}

/// Returns a rotation of a body, in the plane if it is 2D, and a translation by up to `reach`.
inline Pose any_pose_within(shapes::RandomEngine& random, double reach, int dim) {
  const Eigen::Matrix3d r = shapes::random_rotation(random, dim);
  return {r, shapes::uniform(random, 0, reach) * in_space(shapes::random_direction(random), dim)};
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
