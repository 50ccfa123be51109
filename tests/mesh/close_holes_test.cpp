#include <algorithm>
#include <array>
#include <random>
#include <set>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/faulty_meshes.hpp"
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

std::vector<BoundaryLoop> loops_of(const Mesh& m) {
  return find_boundary_loops(m, examine(m).use);
}

/// Closes what can be closed, and checks by other means that nothing that was there has changed, that nothing
/// meets that did not meet before, and that the rims which are left are those it says.
ClosedHoles close(const Mesh& m) {
  const MeshReport before = check_mesh(m);
  ClosedHoles out = close_holes(check(m));
  const MeshReport after = check_mesh(out.mesh);
  CHECK(std::equal(m.vertices.begin(), m.vertices.end(), out.mesh.vertices.begin()));
  CHECK(std::equal(m.face_offsets.begin(), m.face_offsets.end(), out.mesh.face_offsets.begin()));
  CHECK(std::equal(m.face_vertices.begin(), m.face_vertices.end(), out.mesh.face_vertices.begin()));
  for (const MeshFault kind : {MeshFault::self_intersection, MeshFault::non_manifold_edge,
                               MeshFault::flipped_face, MeshFault::zero_area_face, MeshFault::duplicate_face,
                               MeshFault::duplicate_vertex, MeshFault::unused_vertex})
    CHECK(after[kind].count == before[kind].count);
  std::size_t left = 0, faces = m.face_count();
  for (const Hole& hole : out.holes) {
    if (hole.state <= HoleState::closed_as_ring)
      CHECK(hole.faces > 0);
    else
      left += hole.loop.edges();
    if (hole.state == HoleState::closed) faces += hole.faces;
  }
  CHECK(after[MeshFault::open_edge].count == left);
  CHECK(out.new_faces == out.mesh.face_count() - m.face_count());
  if (std::ranges::none_of(out.holes, [](const Hole& h) { return h.state == HoleState::closed_as_ring; }))
    CHECK(faces == out.mesh.face_count());
  return out;
}

Mesh open_box(const Point3& low, const Point3& high) {
  return without_faces_at(box(low, high), [&](const Point3& x) { return x.z() == high.z(); });
}

Mesh with_random_holes(const Mesh& m, double share, unsigned seed) {
  std::mt19937 random(seed);
  std::set<FaceId> gone;
  for (FaceId f = 0; f < m.face_count(); ++f)
    if (std::uniform_real_distribution<>(0, 1)(random) < share) gone.insert(f);
  return without_faces(m, gone);
}

}  // namespace

TEST_CASE("a boundary loop is found completely and measured") {
  CHECK(loops_of(icosphere(1)).empty());
  const auto one = loops_of(without_faces(box(), {7}));
  REQUIRE(one.size() == 1);
  CHECK(one[0].is_loop);
  CHECK(one[0].planar);
  CHECK(one[0].edges() == 3);
  CHECK(one[0].length == doctest::Approx(2 + std::sqrt(2)));

  const auto tube = loops_of(open_cylinder(12));
  REQUIRE(tube.size() == 2);
  for (const BoundaryLoop& rim : tube) {
    CHECK(rim.edges() == 12);
    CHECK(rim.planar);
    CHECK(rim.box.sizes().z() == 0);
  }
  const auto bent =
      loops_of(without_faces_at(open_box({0, 0, 0}, {1, 1, 1}), [](const Point3& x) { return x.x() == 1; }));
  REQUIRE(bent.size() == 1);
  CHECK_FALSE(bent[0].planar);
}

TEST_CASE("every open edge is in one boundary loop, and no loop visits a vertex twice") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Mesh m = with_random_holes(icosphere(2), 0.05 * (seed % 10 + 1), seed);
    std::size_t edges = 0;
    for (const BoundaryLoop& rim : loops_of(m)) {
      CHECK(rim.is_loop);
      edges += rim.edges();
      CHECK(std::set<VertexId>(rim.vertices.begin(), rim.vertices.end()).size() == rim.vertices.size());
    }
    CHECK(edges == check_mesh(m, false)[MeshFault::open_edge].count);
  }
}

TEST_CASE("two touching holes are two loops; a hole interrupted by a fin is no loop") {
  const Mesh ball = icosphere(0);
  std::vector<FaceId> at_first;
  for (FaceId f = 0; f < ball.face_count(); ++f)
    if (std::count(ball.face(f).begin(), ball.face(f).end(), VertexId(0)) > 0) at_first.push_back(f);
  REQUIRE(at_first.size() == 5);
  const auto share = [&](FaceId f, FaceId g) {
    int n = 0;
    for (const VertexId v : ball.face(f)) n += std::count(ball.face(g).begin(), ball.face(g).end(), v) > 0;
    return n;
  };
  const auto across = std::ranges::find_if(at_first, [&](FaceId f) { return share(f, at_first[0]) == 1; });
  const auto rims = loops_of(without_faces(ball, {at_first[0], *across}));
  REQUIRE(rims.size() == 2);
  CHECK(rims[0].edges() == 3);
  CHECK(rims[1].edges() == 3);

  // The fin's own edge at the body has three faces; its two others are open.
  const auto fin = loops_of(
      with_face(ball, {{0, 0, 5}}, {ball.face(FaceId(0))[0], ball.face(FaceId(0))[1], VertexId(12)}));
  REQUIRE(fin.size() == 1);
  CHECK_FALSE(fin[0].is_loop);
  CHECK(fin[0].edges() == 2);
  CHECK(close(with_face(ball, {{0, 0, 5}}, {VertexId(0), VertexId(1), VertexId(12)})).holes[0].state ==
        HoleState::not_a_loop);
}

TEST_CASE("flat holes are closed, also with collinear corners") {
  const ClosedHoles one = close(without_faces(box(), {7}));
  CHECK(one.new_faces == 1);
  CHECK(volume(one.mesh) == doctest::Approx(1));
  const ClosedHoles tube = close(open_cylinder(30));
  CHECK(tube.new_faces == 2 * 28);
  CHECK(check_mesh(tube.mesh).buildable());
  const Mesh cells = without_faces_at(voxels(4, 3, 2, [](int x, int y, int) { return x != 2 || y == 1; }),
                                      [](const Point3& x) { return x.z() == 2; });
  const ClosedHoles shaft = close(cells);
  CHECK(shaft.new_vertices == 0);
  CHECK(check_mesh(shaft.mesh).buildable());
  CHECK(volume(shaft.mesh) == doctest::Approx(2 * 10));
  // A thin one; and a slit, whose fill would have no area but for rounding.
  for (const double height : {1e-5, 1e-7}) {
    Mesh m;
    m.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {0.5, 0, 1}};
    for (const std::uint32_t v : {0, 1, 2})
      m.add_face(std::array{VertexId(v), VertexId((v + 1) % 3), VertexId(3)});
    const ClosedHoles thin = close(m);
    CHECK(thin.holes.at(0).state == (height > 1e-6 ? HoleState::closed : HoleState::no_area));
  }
}

TEST_CASE("random holes: fills intersect nothing, and holes left open are reported") {
  std::size_t closed = 0, all = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const Mesh body = seed % 3 == 0 ? icosphere(2) : seed % 3 == 1 ? torus(16, 10) : comb(3);
    const ClosedHoles out = close(with_random_holes(body, 0.04 * (seed % 8 + 1), seed));
    for (const Hole& hole : out.holes) closed += hole.state <= HoleState::closed_as_ring;
    all += out.holes.size();
  }
  CHECK(closed > all * 9 / 10);
  CHECK(all > 300);
}

TEST_CASE("a fill that would intersect the surface is rejected, and the face in its way is named") {
  const Mesh pole = box({0.4, 0.4, 0.1}, {0.6, 0.6, 3});
  const Mesh pot = open_box({0, 0, 0}, {1, 1, 1});
  const ClosedHoles out = close(several({pot, pole}));
  REQUIRE(out.holes.size() == 1);
  CHECK(out.holes[0].state == HoleState::meets_surface);
  CHECK(out.holes[0].obstacle >= pot.face_count());
  CHECK(out.new_faces == 0);
  // A pole that ends just below the rim's plane is no obstacle, one that ends in it is.
  CHECK(close(several({pot, box({0.4, 0.4, 0.1}, {0.6, 0.6, std::nextafter(1.0, 0)})})).new_faces == 2);
  CHECK(close(several({pot, box({0.4, 0.4, 0.1}, {0.6, 0.6, 1})})).new_faces == 0);

  Mesh triangle;
  triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
  const ClosedHoles alone = close(triangle);  // the lid would be its own back
  CHECK(alone.holes[0].state == HoleState::meets_surface);
  CHECK(alone.holes[0].obstacle == 0);
}

TEST_CASE("two nested loops in one plane are closed by the ring between them") {
  for (const int holes : {1, 2}) {
    const Mesh walls =
        without_faces_at(voxels(2 * holes + 1, 3, 1, [](int x, int y, int) { return y != 1 || x % 2 == 0; }),
                         [](const Point3& x) { return x.z() == 1; });
    const ClosedHoles out = close(walls);
    REQUIRE(out.holes.size() == static_cast<std::size_t>(holes + 1));
    for (const Hole& hole : out.holes) CHECK(hole.state == HoleState::closed_as_ring);
    const MeshReport report = check_mesh(out.mesh);
    CHECK(report.buildable());
    CHECK(report.genus == holes);
    CHECK(volume(out.mesh) == doctest::Approx(3 * (2 * holes + 1) - holes));
  }
  // Loops in loops: each is joined to the smallest around it.
  const ClosedHoles rings = close(without_faces_at(
      voxels(7, 7, 1, [](int x, int y, int) { return std::max(std::abs(x - 3), std::abs(y - 3)) % 2 == 1; }),
      [](const Point3& x) { return x.z() == 1; }));
  REQUIRE(rings.holes.size() == 4);
  for (const Hole& hole : rings.holes) CHECK(hole.state == HoleState::closed_as_ring);
  CHECK(volume(rings.mesh) == doctest::Approx(24 + 8));
  // One pot in another: the inner one can be closed, the outer one's lid would lie on it.
  const ClosedHoles pots = close(several({open_box({0, 0, 0}, {3, 3, 1}), open_box({1, 1, 0.5}, {2, 2, 1})}));
  CHECK(pots.holes[0].state == HoleState::meets_surface);
  CHECK(pots.holes[1].state == HoleState::closed);
  // A sheet with a hole: its rim cannot be closed, for that lid would be its back, but its hole can.
  Mesh sheet = without_faces_at(
      voxels(
          3, 3, 1, [](int, int, int) { return true; }, true),
      [](const Point3& x) { return x.z() == 0 || x.x() == 0 || x.x() == 3 || x.y() == 0 || x.y() == 3; });
  sheet = without_faces(sheet, {4});
  const ClosedHoles filled = close(sheet);
  REQUIRE(filled.holes.size() == 2);
  CHECK(filled.holes[0].state == HoleState::meets_surface);
  CHECK(filled.holes[1].state == HoleState::closed);
}

TEST_CASE("two holes with the same two corners do not both take the edge between them") {
  // A box without its front and back, seen along x: an octahedron's belt, whose upper and lower rims share
  // no edge, but two holes that are left in it share both apexes.
  Mesh m;
  m.vertices = {{0, 0, 1}, {0, 0, -1}, {1, 0.2, 0}, {1, -0.2, 0}, {-1, 0.2, 0}, {-1, -0.2, 0}};
  for (const auto& t : {std::array{0, 3, 2}, std::array{1, 2, 3}, std::array{0, 4, 5}, std::array{1, 5, 4}})
    m.add_face(std::array{VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
  const ClosedHoles out = close(m);
  REQUIRE(out.holes.size() == 2);
  CHECK(out.holes[0].state == HoleState::closed);
  CHECK(out.holes[1].state == HoleState::closed);
  CHECK(check_mesh(out.mesh)[MeshFault::open_edge].count == 0);
}

}  // namespace lrb::test
