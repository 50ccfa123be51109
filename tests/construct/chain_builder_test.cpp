#include <cmath>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/construct/build_checks.hpp"
#include <lrbscope/error.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

/// A closed curve with bumps on bumps.
Mesh coast(int corners) {
  std::vector<Point2> points;
  for (int i = 0; i < corners; ++i) {
    const double a = 2 * std::acos(-1.0) * i / corners;
    const double r = 1 + 0.35 * std::sin(3 * a) + 0.12 * std::sin(11 * a + 1) + 0.06 * std::sin(29 * a);
    points.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return polygon(points);
}

TEST_CASE("2D bodies: valid, embedded according to brute force, few outer segments") {
  const Mesh meshes[] = {circle(64),
                         star(7),
                         gear(16),
                         comb_2d(6),
                         l_shape_2d(),
                         ring_2d(40),
                         coast(90),
                         coast(400),
                         several({coast(90), translated(star(9), {2.2, 1.5, 0})}),
                         several({circle(40, 3), turned_inside_out(circle(30, 2)), star(5)}),
                         several({comb_2d(4), translated(circle(12, 0.2), {1.5, 1.5, 0})})};
  for (const Mesh& mesh : meshes) {
    CAPTURE(mesh.name);
    CAPTURE(mesh.face_count());
    const LrbRep rep = build_lrb(mesh);
    check_keeps_mesh(rep, mesh);
    check_valid(rep);
    CHECK(bad_pairs_by_brute_force(rep) == 0);
    CHECK(rep.outermost_faces().size() <= 10);
  }
}

TEST_CASE("a 2D body has enough layers for a sequence of refinements") {
  const LrbRep rep = build_lrb(coast(90));
  CHECK(rep.layer_count() >= 4);
  CHECK(rep.face_count() < 2 * rep.real_face_count());
}

TEST_CASE("chains of every length") {
  for (const std::uint32_t interior : {4u, 8u, 16u, 32u, 64u}) {
    BuildOptions options;
    options.patch_interior = interior;
    const LrbRep rep = build_lrb(coast(300), options);
    check_valid(rep);
    CHECK(rep.outermost_faces().size() <= 10);
  }
}

TEST_CASE("outlines that cross or touch themselves") {
  const Mesh bow =
      polygon({{0, 0}, {4, 2}, {4, 0}, {0, 3}, {-1, 2}, {-1, 1}, {-2, 2}, {-3, 1}, {-2, 0}, {-1, -1}});
  const Mesh overlap = several({circle(40), translated(circle(40), {1, 0.1, 0})});
  const Mesh beside =
      several({polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), polygon({{1, 0}, {2, 0}, {2, 1}, {1, 1}})});
  for (const Mesh& mesh : {bow, overlap, beside}) {
    const LrbRep rep = build_lrb(mesh);
    check_valid(rep);
    CHECK(bad_pairs_by_brute_force(rep) == 0);
    CHECK(rep.outermost_faces().size() <= 10);
  }
}

TEST_CASE("2D bodies that cannot be built are rejected") {
  Mesh open = circle(10);
  open.face_vertices.resize(open.face_vertices.size() - 2);
  open.face_offsets.pop_back();
  CHECK_THROWS_WITH_AS(build_lrb(open), doctest::Contains("has only one segment"), InputError);
  CHECK_THROWS_WITH_AS(build_lrb(turned_inside_out(circle(10))), doctest::Contains("inside out"), InputError);
}

}  // namespace
}  // namespace lrb::test
