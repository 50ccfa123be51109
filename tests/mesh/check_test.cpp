#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/faulty_meshes.hpp"
#include <lrbscope/mesh_check.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

using Elements = std::vector<std::array<std::uint32_t, 2>>;

Mesh mesh_of(std::vector<Eigen::Vector3d> vertices, const std::vector<std::vector<VertexId>>& faces,
             int dim = 3) {
  Mesh m;
  m.dim = dim;
  m.vertices = std::move(vertices);
  m.name = "m";
  for (const auto& f : faces) m.add_face(f);
  return m;
}

/// Checks that the report has these faults and no others.
void check_faults(const MeshReport& report,
                  const std::vector<std::pair<MeshFault, std::uint64_t>>& expected) {
  std::array<std::uint64_t, kMeshFaultCount> counts{};
  for (const auto& [fault, count] : expected) counts[static_cast<std::size_t>(fault)] = count;
  for (std::size_t i = 0; i < kMeshFaultCount; ++i) {
    CAPTURE(i);
    CHECK(report.findings[i].count == counts[i]);
  }
}

}  // namespace

TEST_CASE("bodies of the tests are closed, manifold, outward and free of self-intersections") {
  struct Expected {
    Mesh mesh;
    std::uint32_t components;
    int genus;
  };
  for (const auto& [mesh, components, genus] : std::vector<Expected>{
           {tetrahedron(), 1, 0},
           {box(), 1, 0},
           {quad_box({-1, -2, -3}, {1, 2, 3}), 1, 0},
           {l_shape(), 1, 0},
           {comb(4), 1, 0},
           {box_with_void(), 2, 0},
           {icosphere(0), 1, 0},
           {icosphere(3), 1, 0},
           {bumpy_sphere(3, 1), 1, 0},
           {uv_sphere(12, 5), 1, 0},
           {bowl(16, 6), 1, 0},
           {torus(12, 8), 1, 1},
           {circle(7), 1, 0},
           {star(5), 1, 0},
           {gear(9), 1, 0},
           {comb_2d(4), 1, 0},
           {l_shape_2d(), 1, 0},
           {ring_2d(9), 2, 0},
           {several({torus(9, 6), translated(torus(7, 5), {9, 0, 0}), icosphere(1, 0.2)}), 3, 2}}) {
    const std::string& body = mesh.name;
    CAPTURE(body);
    const MeshReport report = check_mesh(mesh);
    CHECK(report.lines(mesh).empty());
    CHECK(report.closed);
    CHECK(report.components == components);
    CHECK(report.genus == genus);
    CHECK(report.buildable());
    CHECK(report.queryable());
    CHECK(report.self_intersections_checked);
    Mesh turned = turned_inside_out(mesh);
    CHECK(check_mesh(turned)[MeshFault::inside_out].count == components);
    CHECK(orient_outward(turned) == components);
    CHECK(check_mesh(turned).lines(turned).empty());
  }
  CHECK_FALSE(check_mesh(box(), false).self_intersections_checked);
}

TEST_CASE("each fault is found alone, with its elements, and decides what the mesh is good for") {
  using enum MeshFault;
  const auto changed = [](Mesh mesh, const auto& change) {
    change(mesh);
    return mesh;
  };
  // A needle of an ulp's width has area, a straight one has none.
  const auto needle = [](double z) {
    return mesh_of({{0, 0, 0}, {3, 3, 3 * 0.3125}, {1, 1, z}}, {{0, 1, 2}});
  };
  struct Row {
    Mesh mesh;
    std::vector<std::pair<MeshFault, std::uint64_t>> faults;
    const char* good_for;  ///< c: is closed; b: can be built; q: can be queried
    Elements first = {};   ///< of the first fault
  };
  for (const Row& row : std::vector<Row>{
           {mesh_of({{0, 0, 0}}, {}), {{no_faces, 1}, {unused_vertex, 1}}, ""},
           {changed(tetrahedron(),
                    [](Mesh& m) { m.vertices[2].y() = std::numeric_limits<double>::quiet_NaN(); }),
            {{non_finite_vertex, 1}},
            "c",
            {{2, kNull}}},
           // Of face 1, whose three edges lose a face.
           {changed(tetrahedron(), [](Mesh& m) { m.face_vertices[4] = 4; }),
            {{index_out_of_range, 1}, {open_edge, 3}},
            "",
            {{1, 4}}},
           // No boundary: the body stays closed.
           {changed(tetrahedron(),
                    [](Mesh& m) {
                      m.add_face(std::array<VertexId, 3>{1, 1, 2});
                    }),
            {{repeated_corner, 1}, {zero_area_face, 1}},
            "cq",
            {{4, 1}}},
           {needle(0.3125), {{zero_area_face, 1}, {open_edge, 3}}, "q"},
           {needle(std::nextafter(0.3125, 1)), {{sliver, 1}, {open_edge, 3}}, "q", {{0, kNull}}},
           {mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{0, 1, 2, 3}}),
            {{zero_area_face, 1}, {open_edge, 4}},
            "q"},
           {mesh_of({{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}}, {{0, 1, 2, 3}}),
            {{open_edge, 4}, {duplicate_vertex, 1}},
            "q"},
           // Within the planes of two of its quads.
           {changed(quad_box(), [](Mesh& m) { m.vertices[7].x() = std::nextafter(m.vertices[7].x(), 2); }),
            {{non_planar_face, 1}},
            "cbq"},
           {without_faces(quad_box(), {FaceId(3)}), {{open_edge, 4}}, "q"},
           {open_cylinder(11), {{open_edge, 22}}, "q"},
           // A vertex on the edge of another face; two triangles along a slit.
           {mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 1e-8, 0}},
                    {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {1, 2, 3}, {2, 0, 3}}),
            {{open_edge, 3}, {t_junction, 1}, {self_intersection, 2}},
            "q"},
           {mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1 + 1e-9, 0, 0}, {0, 1 + 1e-9, 0}},
                    {{0, 1, 2}, {4, 3, 5}}),
            {{open_edge, 6}, {near_vertex, 2}},
            "q"},
           // Slivers at every size; none is one with a height of more than 1e-4.
           {scaled(
                mesh_of({{0, 0, 0}, {1, 0, 0}, {0.5, 0.9e-4, 0}, {0.5, 0, 1.1e-4}}, {{0, 1, 2}, {1, 0, 3}}),
                1e-200),
            {{sliver, 1}, {open_edge, 4}},
            "q"},
           {without_faces(circle(6), {FaceId(2)}), {{open_edge, 2}}, "q"},
           {with_vertices(box(), {{5, 5, 5}}), {{unused_vertex, 1}}, "cbq", {{8, kNull}}},
           // Whatever the sign of their zeros.
           {with_vertices(box(), {{0, 0, 0}, {-0.0, 0, 0}, {1, 0, 0}}),
            {{duplicate_vertex, 3}, {unused_vertex, 3}},
            "cbq"}}) {
    const MeshReport report = check_mesh(row.mesh);
    CAPTURE(report.lines(row.mesh).empty());
    check_faults(report, row.faults);
    const std::string good_for = std::string(report.closed ? "c" : "") + (report.buildable() ? "b" : "") +
                                 (report.queryable() ? "q" : "");
    CHECK(good_for == row.good_for);
    if (!row.first.empty()) CHECK(report[row.faults[0].first].first == row.first);
  }
  const MeshReport open = check_mesh(without_faces(quad_box(), {FaceId(3)}));
  CHECK_FALSE(open.bounds_solid);
  CHECK(open.genus == -1);
  CHECK(open.components == 1);
  // Duplicate faces, whatever their first corner and orientation.
  Mesh m = tetrahedron();
  m.add_face(std::array<VertexId, 3>{3, 1, 0});
  m.add_face(std::array<VertexId, 3>{0, 3, 1});
  const MeshReport twice = check_mesh(m, false);
  CHECK(twice[duplicate_face].first == Elements{{1, 4}, {1, 5}});
  CHECK(twice[non_manifold_edge].count == 3);
  CHECK_FALSE(twice.buildable());
}

TEST_CASE("convexity of polygons, whatever plane they lie in") {
  struct Polygon {
    std::vector<Eigen::Vector2d> corners;
    bool convex;
  };
  const std::vector<Polygon> polygons = {
      {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, true},
      {{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}}, true},     // corners in the middle of sides
      {{{0, 0}, {4, 0}, {1, 1}, {0, 4}}, false},                    // an arrow
      {{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, false},                    // a bow tie, area 0
      {{{0, 0}, {3, 1}, {3, 0}, {0, 2}}, false},                    // a bow tie with area
      {{{0, 0}, {2, 0}, {1, 0}, {1, 1}}, false},                    // a side that turns back
      {{{0, 2}, {-1, -2}, {2, 1}, {-2, 1}, {1, -2}}, false},        // a pentagram: goes round twice
      {{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 0}, {1, 1}}, false},    // a triangle, twice
      {{{0, 0}, {1, 0}, {1 + 0x1p-52, 1}, {1, 2}, {0, 2}}, true},   // hardly convex
      {{{0, 0}, {1, 0}, {1 - 0x1p-53, 1}, {1, 2}, {0, 2}}, false},  // hardly concave
  };
  for (const auto& [corners, convex] : polygons)
    for (const bool turned : {false, true})
      for (int plane = 0; plane < 4; ++plane)
        for (const double size : {1.0, 0x1p-400, 0x1p400}) {
          std::vector<Eigen::Vector3d> vertices;
          std::vector<VertexId> face;
          for (const auto& c : corners) {
            const double x = size * c.x(), y = size * c.y();
            face.push_back(static_cast<VertexId>(vertices.size()));
            vertices.push_back(plane == 0   ? Eigen::Vector3d(x, y, 3 * size)
                               : plane == 1 ? Eigen::Vector3d(0, x, y)
                               : plane == 2 ? Eigen::Vector3d(y, -size, x)
                                            : Eigen::Vector3d(x, y, -4 * x));
          }
          if (turned) std::reverse(face.begin(), face.end());
          const MeshReport report = check_mesh(mesh_of(vertices, {face}), false);
          const std::size_t size_of_face = face.size();
          CAPTURE(size_of_face);
          CAPTURE(plane);
          CHECK(report[MeshFault::non_planar_face].count == 0);
          CHECK(report[MeshFault::non_convex_face].count == (convex ? 0 : 1));
        }
}

TEST_CASE("two cubes that share an edge, or a vertex") {
  const Mesh edge = voxels(2, 2, 1, [](int i, int j, int) { return i == j; });
  MeshReport report = check_mesh(edge);
  check_faults(report, {{MeshFault::non_manifold_edge, 1}});
  CHECK(report.components == 1);
  CHECK_FALSE(report.closed);
  CHECK(report.bounds_solid);  // inside still has a meaning
  CHECK_FALSE(report.buildable());
  const auto [a, b] = report[MeshFault::non_manifold_edge].first.at(0);
  CHECK(edge.vertices[a].head<2>() == Eigen::Vector2d(1, 1));
  CHECK(edge.vertices[b].head<2>() == Eigen::Vector2d(1, 1));

  const Mesh vertex = voxels(2, 2, 2, [](int i, int j, int k) { return i == j && j == k; });
  report = check_mesh(vertex);
  check_faults(report, {{MeshFault::non_manifold_vertex, 1}});
  CHECK(vertex.vertices[report[MeshFault::non_manifold_vertex].first.at(0)[0]] == Eigen::Vector3d(1, 1, 1));
  CHECK(report.components == 2);
  CHECK(report.closed);
  CHECK(report.genus == -1);
  CHECK(report.buildable());

  // In the plane: two squares that share a corner.
  const Mesh squares = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}},
                               {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 4}, {4, 5}, {5, 6}, {6, 2}}, 2);
  report = check_mesh(squares);
  check_faults(report, {{MeshFault::non_manifold_edge, 1}});
  CHECK(report[MeshFault::non_manifold_edge].first == Elements{{2, kNull}});
}

TEST_CASE("faces flipped against their neighbours") {
  const MeshReport report = check_mesh(with_flipped(icosphere(1), {FaceId(17)}));
  check_faults(report, {{MeshFault::flipped_face, 3}, {MeshFault::reversed_face, 1}});
  CHECK(report[MeshFault::reversed_face].first == Elements{{17, kNull}});
  CHECK_FALSE(report.closed);
  CHECK_FALSE(report.buildable());
  for (const auto& pair : report[MeshFault::flipped_face].first) CHECK((pair[0] == 17 || pair[1] == 17));

  Mesh moebius;  // a strip of quads closed with half a turn: wherever it is cut, one pair runs the same way
  for (int i = 0; i < 9; ++i) {
    const double u = 2 * std::numbers::pi * i / 9, half = u / 2;
    for (const double w : {-0.3, 0.3})
      moebius.vertices.emplace_back((1 + w * std::cos(half)) * std::cos(u),
                                    (1 + w * std::cos(half)) * std::sin(u), w * std::sin(half));
  }
  for (int i = 0; i < 8; ++i) {
    const VertexId a(2 * i), b(2 * i + 1), c(2 * i + 2), d(2 * i + 3);
    moebius.add_face(std::array{a, c, b});
    moebius.add_face(std::array{b, c, d});
  }
  moebius.add_face(std::array<VertexId, 3>{16, 1, 17});
  moebius.add_face(std::array<VertexId, 3>{17, 1, 0});
  check_faults(check_mesh(moebius), {{MeshFault::flipped_face, 1}, {MeshFault::open_edge, 18}});

  Mesh flat = circle(5);
  std::swap(flat.face_vertices[4], flat.face_vertices[5]);
  check_faults(check_mesh(flat), {{MeshFault::flipped_face, 2}, {MeshFault::reversed_face, 1}});
  // For each surface the smaller part; of two halves, neither.
  const auto reversed = [](const std::set<FaceId>& faces) {
    return check_mesh(
               with_flipped(several({box(), translated(box(), {3, 0, 0})}), faces))[MeshFault::reversed_face]
        .first;
  };
  CHECK(reversed({FaceId(1), FaceId(12), FaceId(13), FaceId(14), FaceId(15), FaceId(16), FaceId(17),
                  FaceId(18)}) ==
        Elements{{1, kNull}, {19, kNull}, {20, kNull}, {21, kNull}, {22, kNull}, {23, kNull}});
  CHECK(reversed({FaceId(0), FaceId(1), FaceId(2), FaceId(3), FaceId(4), FaceId(5)}).empty());
}

}  // namespace lrb::test
