#include "engine/mesh/nesting.hpp"

#include <numeric>
#include <random>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/mesh_check.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

std::vector<FaceId> all_faces(const Mesh& m) {
  std::vector<FaceId> faces(m.face_count());
  std::iota(faces.begin(), faces.end(), FaceId{0});
  return faces;
}

Mesh shell(int level, double radius, bool outward, const Point3& centre = {0, 0, 0}) {
  const Mesh m = icosphere(level, radius, centre);
  return outward ? m : turned_inside_out(m);
}

/// The triangles of all fans, in their numbering, each as a sorted set of corners.
std::vector<std::array<VertexId, 3>> fan_triangles(const Mesh& m) {
  std::vector<std::array<VertexId, 3>> out;
  for (FaceId f = 0; f < m.face_count(); ++f) {
    const auto c = m.face(f);
    for (std::size_t i = 1; i + 1 < c.size(); ++i) {
      out.push_back({c[0], c[i], c[i + 1]});
      std::sort(out.back().begin(), out.back().end());
    }
  }
  return out;
}

/// Of a point whose neighbourhood reaches into `around` cells, `full` of them solid.
PointSide expected_side(int full, int around) {
  if (full == 0) return PointSide::outside;
  return full == around ? PointSide::inside : PointSide::on_surface;
}

}  // namespace

TEST_CASE("a point inside, outside or on a body of cells") {
  std::mt19937_64 random(5);
  for (int round = 0; round < 4; ++round) {
    const int n = 4;
    std::array<bool, 64> cells{};
    for (bool& c : cells) c = random() % 2 == 0;
    const auto solid = [&](int i, int j, int k) {
      return i >= 0 && j >= 0 && k >= 0 && i < n && j < n && k < n && cells[(i * n + j) * n + k];
    };
    const Mesh m = voxels(n, n, n, solid);
    const std::vector<FaceId> faces = all_faces(m);
    // Half steps: centres of cells, of their faces and edges, and corners.
    for (int x = -1; x <= 2 * n + 1; ++x)
      for (int y = -1; y <= 2 * n + 1; ++y)
        for (int z = -1; z <= 2 * n + 1; ++z) {
          int around = 0, full = 0;  // cells whose closure holds the point
          const auto cell = [](int c) { return c >= 0 ? c / 2 : -1; };
          for (int i = cell(x - 1); i <= cell(x); ++i)
            for (int j = cell(y - 1); j <= cell(y); ++j)
              for (int k = cell(z - 1); k <= cell(z); ++k) {
                ++around;
                full += solid(i, j, k);
              }
          CHECK(point_side(m, faces, {x / 2.0, y / 2.0, z / 2.0}) == expected_side(full, around));
        }
  }
}

TEST_CASE("a point inside, outside or on a polygon") {
  const Mesh m = comb_2d(3, 2);  // columns 0, 2, 4 are full, columns 1 and 3 up to height 1
  const std::vector<FaceId> faces = all_faces(m);
  const auto solid = [](int i, int j) {
    return i >= 0 && i < 5 && j >= 0 && (j < 1 || (j < 3 && i % 2 == 0));
  };
  for (int x = -1; x <= 12; ++x)
    for (int y = -1; y <= 8; ++y) {
      int around = 0, full = 0;
      const auto cell = [](int c) { return c >= 0 ? c / 2 : -1; };
      for (int i = cell(x - 1); i <= cell(x); ++i)
        for (int j = cell(y - 1); j <= cell(y); ++j) {
          ++around;
          full += solid(i, j);
        }
      CHECK(point_side(m, faces, {x / 2.0, y / 2.0, 0}) == expected_side(full, around));
    }
}

TEST_CASE("the sign of a volume is exact") {
  std::mt19937_64 random(11);
  int zero = 0, decided = 0;
  for (int round = 0; round < 2000; ++round) {
    // Corners on a grid of small integers, whose determinant is one of integers; the grid lies far out.
    std::int64_t grid[4][3], d[3][3];
    for (auto& corner : grid)
      for (auto& x : corner) x = static_cast<std::int64_t>(random() % 1000);
    if (round % 2 == 0)  // in the plane of the other three, or one step beside it
      for (int k = 0; k < 3; ++k) grid[3][k] = grid[1][k] + 7 * (grid[2][k] - grid[0][k]) + (k == round % 5);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) d[i][k] = grid[i + 1][k] - grid[0][k];
    const std::int64_t det = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                             d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                             d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    const double step = round % 3 == 0 ? 0x1p-30 : round % 3 == 1 ? 0x1p-400 : 1;
    const double offset = round % 4 == 0 ? 0 : step * 0x1p40;
    Mesh m = tetrahedron();
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) m.vertices[i][k] = offset + step * static_cast<double>(grid[i][k]);
    CHECK(volume_sign(m, all_faces(m)) == (det > 0) - (det < 0));
    det == 0 ? ++zero : ++decided;
  }
  CHECK(zero > 100);
  CHECK(decided > 100);
  for (const double size : {0x1p-340, 0x1p-300, 1.0, 0x1p300, 0x1p340}) {
    CHECK(volume_sign(scaled(icosphere(1), size), all_faces(icosphere(1))) == 1);
    CHECK(volume_sign(turned_inside_out(scaled(icosphere(1), size)), all_faces(icosphere(1))) == -1);
    CHECK(volume_sign(scaled(star(5), size), all_faces(star(5))) == 1);
  }
}

TEST_CASE("components inside others are voids, and solid again inside those") {
  Mesh nest = several({shell(2, 4, true), shell(2, 3, false), shell(1, 2, true), shell(1, 1, false),
                       shell(1, 1, true, {10, 0, 0})});
  CHECK(check_mesh(nest).lines(nest).empty());
  CHECK(orient_outward(nest) == 0);

  Mesh all_outward = several({shell(2, 4, true), shell(2, 3, true), shell(1, 2, true), shell(1, 1, true),
                              shell(1, 1, true, {10, 0, 0})});
  const MeshFinding finding = check_mesh(all_outward)[MeshFault::inside_out];
  CHECK(finding.count == 2);
  CHECK(finding.first[0][0] == 320);
  CHECK(orient_outward(all_outward) == 2);
  CHECK(check_mesh(all_outward).lines(all_outward).empty());

  Mesh all_inward = turned_inside_out(nest);
  CHECK(orient_outward(all_inward) == 5);
  CHECK(check_mesh(all_inward).lines(all_inward).empty());

  Mesh rings = several({circle(9, 3), circle(7, 2), turned_inside_out(circle(5, 1))});
  CHECK(orient_outward(rings) == 2);
  CHECK(check_mesh(rings).lines(rings).empty());
}

TEST_CASE("a void that touches its body's surface") {
  Mesh m = several({box({0, 0, 0}, {4, 4, 4}), box({0, 1, 1}, {1, 2, 2})});  // in the plane x = 0
  CHECK(orient_outward(m) == 1);
  CHECK(check_mesh(m)[MeshFault::inside_out].count == 0);
}

TEST_CASE("a duplicated component is not a void of itself") {
  Mesh m = several({icosphere(2), icosphere(2)});
  CHECK(orient_outward(m) == 0);
  m = several({icosphere(2), turned_inside_out(icosphere(2))});
  CHECK(orient_outward(m) == 1);
}

TEST_CASE("intersecting components are not nested") {
  for (const Point3& offset : {Point3(0.9, 0.1, 0.2), Point3(1.5, 0, 0), Point3(0.3, 0.3, 0.3)}) {
    Mesh m = several({icosphere(2), translated(icosphere(2), offset)});
    CHECK(orient_outward(m) == 0);
    CHECK(check_mesh(m)[MeshFault::self_intersection].count > 0);
  }
  // The small one's box lies in the large one's, and its first vertex inside: yet it cuts through the
  // surface.
  Mesh m = several({icosphere(2, 2), icosphere(1, 0.5, {1.1, 1.1, 1.1})});
  CHECK(check_mesh(m)[MeshFault::self_intersection].count > 0);
  CHECK(orient_outward(m) == 0);
  m = several({icosphere(2, 2), turned_inside_out(icosphere(1, 0.5, {1.1, 1.1, 1.1}))});
  CHECK(orient_outward(m) == 1);
}

TEST_CASE("open components are unchanged") {
  Mesh m = several({open_cylinder(8), turned_inside_out(box({3, 3, 3}, {4, 4, 4}))});
  const Mesh before = m;
  CHECK(orient_outward(m) == 1);
  CHECK(std::equal(m.face_vertices.begin(), m.face_vertices.begin() + 48, before.face_vertices.begin()));
  CHECK(check_mesh(m)[MeshFault::inside_out].count == 0);
}

TEST_CASE("flipped triangles and quads keep their triangles' numbers") {
  for (const Mesh& body : {icosphere(1), quad_box(), quad_torus(8, 5)}) {
    Mesh m = turned_inside_out(body);
    const auto before = fan_triangles(m);
    CHECK(orient_outward(m) == 1);
    CHECK(fan_triangles(m) == before);
  }
}

}  // namespace lrb::test
