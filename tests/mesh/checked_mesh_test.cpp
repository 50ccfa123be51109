#include <random>
#include <type_traits>

#include <doctest/doctest.h>

#include "engine/mesh/nesting.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::test {
namespace {

using namespace shapes;

// Only check() can make one, and its mesh cannot be changed, so that it need not be checked again.
static_assert(!std::is_default_constructible_v<CheckedMesh>);
static_assert(!std::is_constructible_v<CheckedMesh, Mesh>);
static_assert(!std::is_constructible_v<CheckedMesh, MeshFindings>);
static_assert(std::is_same_v<decltype(std::declval<CheckedMesh&>().mesh()), const Mesh&>);
static_assert(std::is_same_v<decltype(std::declval<CheckedMesh&>().report()), const MeshReport&>);

bool same(const MeshReport& a, const MeshReport& b) {
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (a.findings[i].count != b.findings[i].count || a.findings[i].first != b.findings[i].first)
      return false;
  return a.components == b.components && a.genus == b.genus && a.closed == b.closed &&
         a.bounds_solid == b.bounds_solid && a.self_intersections_checked == b.self_intersections_checked;
}

std::vector<Mesh> bodies() {
  return {icosphere(1),
          turned_inside_out(icosphere(1)),
          several({icosphere(2, 2), icosphere(1, 0.5)}),
          several({quad_box(), turned_inside_out(quad_box({3, 3, 3}, {4, 4, 4}))}),
          several({box(), translated(box(), {0.5, 0.5, 0.5})}),
          open_cylinder(8),
          several({open_cylinder(8), turned_inside_out(box({3, 3, 3}, {4, 4, 4}))}),
          turned_inside_out(circle(9)),
          ring_2d(12),
          Mesh{}};
}

TEST_CASE("a checked mesh has the report of check_mesh(), before and after orientation") {
  for (const Mesh& m : bodies()) {
    CAPTURE(m.face_count());
    CheckedMesh checked = check(m);
    CHECK(same(checked.report(), check_mesh(m, false)));
    Mesh turned = m;
    const std::uint32_t count = orient_outward(turned);
    CHECK(checked.turn_outward() == count);
    CHECK(checked.mesh().face_vertices == turned.face_vertices);
    CHECK(same(checked.report(), check_mesh(turned, false)));
    CHECK(same(check_mesh(turned, false), check_mesh(m, false).when_turned()));
    const CheckedMesh again = check(turned);
    CHECK((checked.use() == again.use()));
    CHECK((checked.topology().component_of_face == again.topology().component_of_face));
    CHECK((checked.topology().component_closed == again.topology().component_closed));
    Workers workers(2);
    const std::vector<FaceId> meeting = checked.self_intersecting_faces(workers);
    checked.find_self_intersections();
    checked.find_self_intersections();  // counts nothing twice
    CHECK(same(checked.report(), check_mesh(turned)));
    CHECK((checked.self_intersecting_faces(workers) == meeting));
  }
}

TEST_CASE("one ray finds the same sides of surfaces as one ray per surface") {
  std::mt19937_64 random(3);
  for (const Mesh& m : {several({icosphere(2, 2), turned_inside_out(icosphere(1, 1)), icosphere(1, 0.5),
                                 translated(icosphere(1), {2, 0, 0}), box({-1, -1, -1}, {1, 1, 1})}),
                        several({circle(30, 2), circle(20, 1), circle(5, 0.5), star(7)})}) {
    const CheckedMesh checked = check(m);
    const SideFinder finder(m, checked.topology().component_of_face);
    std::vector<std::vector<FaceId>> faces(checked.report().components);
    for (FaceId f = 0; f < m.face_count(); ++f) faces[checked.topology().component_of_face[f]].push_back(f);
    std::vector<Eigen::Vector3d> points = m.vertices;
    for (int i = 0; i < 2000; ++i)
      points.emplace_back(static_cast<int>(random() % 65) / 16.0 - 2,
                          static_cast<int>(random() % 65) / 16.0 - 2,
                          m.dim == 2 ? 0 : static_cast<int>(random() % 65) / 16.0 - 2);
    for (const Eigen::Vector3d& p : points) {
      std::vector<PointSide> sides(faces.size(), PointSide::outside);
      for (const auto& s : finder.sides(p)) sides[s.surface] = s.side;
      for (std::size_t c = 0; c < faces.size(); ++c) CHECK(sides[c] == point_side(m, faces[c], p));
    }
  }
}

}  // namespace
}  // namespace lrb::test
