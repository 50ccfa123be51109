#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/random_simplices.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

std::vector<std::vector<Point3>> corner_places(const Mesh& m) {
  std::vector<std::vector<Point3>> out;
  for (FaceId f = 0; f < m.face_count(); ++f) {
    out.emplace_back();
    for (const VertexId v : m.face(f)) out.back().push_back(m.vertices[v]);
  }
  return out;
}

/// Checks that no face and no vertex has moved or changed its number, and returns the report.
MeshReport joined_report(Mesh m, JoinedCorners* said = nullptr) {
  const Mesh before = m;
  const JoinedCorners joined = join_corners(m);
  if (said) *said = joined;
  CHECK(corner_places(m) == corner_places(before));
  CHECK(m.vertices == before.vertices);
  CHECK(m.joined.size() == joined.before - joined.after);
  const MeshReport report = check_mesh(m);
  CHECK(report[MeshFault::open_edge].count == joined.open_after);
  CHECK(report[MeshFault::unused_vertex].count == check_mesh(before, false)[MeshFault::unused_vertex].count);
  return report;
}

}  // namespace

TEST_CASE("a soup of triangles or segments is merged into the body that it came from") {
  for (const Mesh& body : {box(), quad_box(), comb(3), torus(8, 5), icosphere(2), box_with_void(), l_shape(),
                           star(5), ring_2d(12)}) {
    JoinedCorners said;
    const MeshReport was = check_mesh(body), is = joined_report(as_soup(body), &said);
    CHECK(said.open_before == as_soup(body).face_vertices.size());
    CHECK(said.open_after == 0);
    CHECK(said.after == body.vertices.size());
    CHECK(is.buildable());
    CHECK(is.genus == was.genus);
    CHECK(is.components == was.components);
    CHECK(is[MeshFault::duplicate_vertex].count == 0);
  }
}

TEST_CASE("a soup with displaced corners is welded into its body, or rejected; closed parts do not change") {
  constexpr double kOff = 1e-9, kDistance = 4e-9;
  Rng rng(3);
  for (const Mesh& body : {box(), quad_box(), comb(3), torus(8, 5), icosphere(2), box_with_void()}) {
    Mesh soup = as_soup(body);
    for (Point3& x : soup.vertices)
      for (int i = 0; i < 3; ++i) x[i] += kOff * (2 * random_unit(rng) - 1);
    const CheckedMesh slit = check(several({soup, box({9, 9, 9}, {10, 10, 10})}));
    WeldedCorners done;
    const CheckedMesh whole = weld_corners(slit, kDistance, done);
    CHECK(whole.report().closed);
    CHECK(whole.report().components == check_mesh(body).components + 1);
    CHECK(done.welded == soup.vertices.size() - body.vertices.size());
    CHECK(done.farthest > kOff);
    CHECK(done.farthest <= kDistance);
    for (VertexId v = 0; v < slit.mesh().vertices.size(); ++v) {
      const double moved = (whole.mesh().vertices[v] - slit.mesh().vertices[v]).norm();
      CHECK(moved <= (v < soup.vertices.size() ? done.farthest : 0));
    }
    // Corners of different edges of a face would become one.
    CHECK_THROWS_WITH_AS(weld_corners(slit, 3, done), doctest::Contains("weld"), InputError);
    CHECK_THROWS_WITH_AS(weld_corners(slit, 0, done), doctest::Contains("above 0"), InputError);
    CHECK(weld_corners(check(turned_inside_out(soup)), kDistance, done).report().closed);
  }
  const auto loose = [](std::initializer_list<std::vector<Point3>> faces) {
    Mesh m;
    for (const auto& face : faces) add_loose(m, face);
    return check(m);
  };
  WeldedCorners done;
  // No corner moves further, from one that moved to another.
  weld_corners(loose({{{0, 0, 0}, {9, 1, 0}, {9, 2, 0}},
                      {{0.9, 0, 0}, {9, 5, 0}, {9, 6, 0}},
                      {{1.8, 0, 0}, {9, 9, 0}, {5, 9, 0}}}),
               0.95, done);
  CHECK(done.welded == 1);
  // The weld gives a face an area, and takes it from another; moves a face through another.
  CHECK_THROWS_WITH_AS(weld_corners(loose({{{2, 1e-7, 0}, {3, 0, 1}, {3, 1, 1}},
                                           {{1, 5, 0}, {1, 6, 1}, {2, 6, 1}},
                                           {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                                           {{0, 5, 0}, {1, 5, 1e-7}, {2, 5, 0}}}),
                                    1e-6, done),
                       doctest::Contains("zero area face (1 in place of 1 elsewhere)"), InputError);
  CHECK_THROWS_WITH_AS(weld_corners(loose({{{0, 0, 0}, {1, 0, -2}, {-1, 0, -2}},
                                           {{0, 0, 1}, {1, 0, 3}, {-1, 0, 3}},
                                           {{-9, -9, 0.5}, {9, -9, 0.5}, {0, 9, 0.5}}}),
                                    1.2, done),
                       doctest::Contains("would intersect another one"), InputError);
}

TEST_CASE("closed bodies are unchanged, wherever they touch") {
  const Mesh edge = several({box(), box({1, 1, 0}, {2, 2, 1})}),
             corner = several({box(), box({1, 1, 1}, {2, 2, 2})}),
             face = several({quad_box(), quad_box({1, 0, 0}, {2, 1, 1})}), twice = several({box(), box()});
  for (const Mesh& body : {edge, corner, face, twice}) {
    Mesh m = body;
    CHECK_FALSE(join_corners(m).any());
    CHECK(m.face_vertices == body.face_vertices);
    CHECK(m.joined.empty());
  }
  // Nor does an open body that touches one take hold of it.
  Mesh m = several({box(), as_soup(box({1, 1, 0}, {2, 2, 1}))});
  join_corners(m);
  for (FaceId f = 0; f < 12; ++f)
    for (const VertexId v : m.face(f)) CHECK(v < 8);
  CHECK(check_mesh(m).buildable());
}

TEST_CASE("a soup of two touching bodies becomes two bodies, if their other edges decide") {
  for (const Mesh& other : {box({1, 1, 0}, {2, 2, 1}), box({1, 1, 1}, {2, 2, 2})}) {
    const MeshReport report = joined_report(as_soup(several({box(), other})));
    CHECK(report.components == 2);
    CHECK(report.buildable());
  }
  // Two coincident faces: it is undecided which belongs to which body, but both are closed as one.
  const MeshReport stacked = joined_report(as_soup(several({quad_box(), quad_box({1, 0, 0}, {2, 1, 1})})));
  CHECK(stacked[MeshFault::open_edge].count == 0);
  CHECK(stacked.bounds_solid);
}

TEST_CASE("coincident boundary loops are merged; faults remain") {
  const auto half = [](bool upper) {  // of a box, cut at z = 1
    const Mesh whole = upper ? box({0, 0, 1}, {1, 1, 2}) : box();
    return without_faces_at(whole, [](const Point3& x) { return x.z() == 1; });
  };
  JoinedCorners said;
  CHECK(joined_report(several({half(false), half(true)}), &said).buildable());
  CHECK(said.open_before == 8);

  const Mesh ball = icosphere(0);
  const MeshReport hole = joined_report(as_soup(without_faces(ball, {3})));
  CHECK(hole[MeshFault::open_edge].count == 3);
  const Mesh flipped = as_soup(with_flipped(ball, {3}));
  CHECK(joined_report(flipped)[MeshFault::flipped_face].count == 3);
  const Mesh doubled = as_soup(with_doubled(ball, {3}));
  CHECK(joined_report(doubled)[MeshFault::non_manifold_edge].count == 3);
}

TEST_CASE("0 and -0 coincide, values an ulp apart do not") {
  Mesh m = as_soup(box());
  for (Point3& x : m.vertices)
    if (x.x() == 0 && (&x - m.vertices.data()) % 2 == 0) x.x() = -0.0;
  CHECK(joined_report(m).buildable());
  m.vertices[0].x() = std::nextafter(m.vertices[0].x(), 2);
  CHECK(joined_report(m)[MeshFault::open_edge].count > 0);
}

TEST_CASE("faces with invalid indices or coordinates are left unchanged") {
  Mesh m = as_soup(box());
  m.face_vertices[0] = VertexId(1000);
  m.vertices[5].y() = std::numeric_limits<double>::quiet_NaN();
  const Mesh before = m;
  join_corners(m);
  CHECK(m.face(FaceId(0))[0] == 1000);
  CHECK(std::equal(m.face(FaceId(1)).begin(), m.face(FaceId(1)).end(), before.face(FaceId(1)).begin()));
}

}  // namespace lrb::test
