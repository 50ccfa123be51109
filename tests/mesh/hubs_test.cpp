// Faces with very many corners and vertices with very many faces: found is what comparing all with all finds.

#include "engine/mesh/hubs.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <doctest/doctest.h>

#include "engine/exact/predicates.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include "engine/mesh/self_intersections.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::test {
namespace {

using namespace shapes;
using namespace hard;
using FacePair = std::array<FaceId, 2>;
using Triangle = std::array<VertexId, 3>;

std::vector<FaceUse> uses_of(const Mesh& m) {
  MeshReport unused;
  return check_faces(m, unused);
}

std::set<FacePair> found_in(const Mesh& m) {
  std::set<FacePair> found;
  find_self_intersections(m, uses_of(m), [&](FaceId f, FaceId g) { CHECK(found.insert({f, g}).second); });
  return found;
}

std::vector<Triangle> triangles_of(const Mesh& m, FaceId f, FaceUse use) {
  std::vector<Triangle> out;
  if (use < FaceUse::area) return out;
  const auto c = m.face(f);
  if (use == FaceUse::convex) {
    triangulate_convex(m, c, out);
    return out;
  }
  cut_polygon(m, f, out);
  std::erase_if(out, [&](const Triangle& t) {
    return exact::collinear3d(m.vertices[t[0]].data(), m.vertices[t[1]].data(), m.vertices[t[2]].data());
  });
  return out;
}

bool are_clear(const Mesh& m, const Triangle& s, const Triangle& t) {
  const double *a[3], *b[3];
  for (int k = 0; k < 3; ++k) {
    a[k] = m.vertices[s[k]].data();
    b[k] = m.vertices[t[k]].data();
  }
  return exact::meet_only_in_shared(a, s.data(), b, t.data());
}

/// By comparing all triangles of all faces.
std::set<FacePair> expected_in(const Mesh& m) {
  const auto use = uses_of(m);
  std::vector<std::vector<Triangle>> parts;
  for (FaceId f = 0; f < m.face_count(); ++f) parts.push_back(triangles_of(m, f, use[f]));
  std::set<FacePair> found;
  for (FaceId f = 0; f < m.face_count(); ++f)
    for (FaceId g(f + 1); g < m.face_count(); ++g) {
      const auto meets = [&](const Triangle& s) {
        return std::any_of(parts[g].begin(), parts[g].end(),
                           [&](const Triangle& t) { return !are_clear(m, s, t); });
      };
      if (std::any_of(parts[f].begin(), parts[f].end(), meets)) found.insert({f, g});
    }
  return found;
}

constexpr std::uint32_t kMany = 90;  // more than kFewNeighbours

TEST_CASE("self-intersections at high-valence vertices and large faces agree with brute force") {
  std::vector<Mesh> meshes;
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const double by : {0.003, 0.03, 0.3}) {
      meshes.push_back(shaken(bipyramid(kMany), by, seed));
      meshes.push_back(shaken(crown(kMany), by, seed));
      meshes.push_back(shaken(fan_disk(kMany), by, seed));
    }
  meshes.push_back(cog(kMany));
  meshes.push_back(several({drum(kMany), translated(drum(kMany), {0.3, 0.2, 0.5})}));
  meshes.push_back(several({drum(kMany), translated(drum(kMany), {0, 0, 1})}));
  meshes.push_back(several({drum(kMany), translated(scaled(drum(kMany), 0.5), {0, 0, 1})}));
  meshes.push_back(several({drum(kMany), drum(kMany)}));
  meshes.push_back(several({cone(kMany), translated(scaled(bipyramid(kMany), 0.4), {0.1, 0, 0.1})}));
  meshes.push_back(several({fine_box(4 * kMany), translated(icosphere(2), {0.5, 0.5, 1})}));
  meshes.push_back(several({fan_disk(kMany), fan_disk(kMany)}));
  std::size_t found = 0;
  for (const Mesh& m : meshes) {
    CAPTURE(m.face_count());
    const auto expected = expected_in(m);
    CHECK((found_in(m) == expected));
    found += expected.size();
    Workers workers(3);
    std::set<FaceId> faces;
    for (const FacePair& p : expected) faces.insert(p.begin(), p.end());
    CHECK(
        (self_intersecting_faces(m, uses_of(m), workers) == std::vector<FaceId>(faces.begin(), faces.end())));
  }
  CHECK(found > 10000);
}

TEST_CASE("a chord of a large face is not an edge that others may share") {
  // A fin on the line between two corners of the drum's end that are not neighbours.
  for (const std::uint32_t other : {2u, 7u, kMany / 2, kMany - 2}) {
    Mesh m = drum(kMany);
    const VertexId tip = static_cast<VertexId>(m.vertices.size());
    m.vertices.emplace_back(0.1, 0.2, 3);
    m.add_face(std::array{VertexId(kMany), VertexId(kMany + other), tip});
    CHECK(found_in(m).contains(FacePair{1, static_cast<FaceId>(m.face_count() - 1)}));
    m.face_vertices[m.face_vertices.size() - 2] = VertexId(kMany + 1);  // a neighbour
    CHECK_FALSE(found_in(m).contains(FacePair{1, static_cast<FaceId>(m.face_count() - 1)}));
  }
}

TEST_CASE("rotated boxes never separate faces with a common point") {
  std::mt19937_64 random(5);
  const auto number = [&] { return static_cast<double>(random() % 4096) / 2048 - 1; };
  int apart = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d shared(number(), number(), number());
    const auto about = [&](double size) {
      std::vector<Eigen::Vector3d> points = {shared};
      for (int k = 0; k < 3; ++k)
        points.push_back(
            (shared + size * Eigen::Vector3d(number(), number(), number())).cwiseMin(1).cwiseMax(-1));
      return points;
    };
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 40));
    std::vector<Eigen::Vector3d> a = about(size), b = about(1);
    CHECK_FALSE(proven_disjoint(OrientedBox::about(a), OrientedBox::about(b)));
    for (Eigen::Vector3d& p : a) p += Eigen::Vector3d(3 * size, 0, 0);
    apart += proven_disjoint(OrientedBox::about(a), OrientedBox::about(b));
  }
  CHECK(apart > 1000);
}

}  // namespace
}  // namespace lrb::test
