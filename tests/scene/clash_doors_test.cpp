// B2: one definition of clash: the same answer through every interface, and a reason if it is undecided.
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

using namespace lrb;

namespace {

/// A ball of which one corner is pulled out through the other side.
Mesh pulled_through() {
  Mesh mesh = shapes::icosphere(1);
  mesh.vertices[0] *= -1.5;
  return mesh;
}

struct Row {
  const char* name;
  Mesh mesh;
  ClashReason as_a, as_b;  ///< why its kinds are undecided; none: they are decided
  bool closed = true;
};

std::vector<Row> rows() {
  using enum ClashReason;
  const Mesh ball = shapes::icosphere(1);
  const Mesh hollow = shapes::several({ball, shapes::turned_inside_out(shapes::icosphere(1, 0.6))});
  return {{"clean", ball, none, none},
          {"crosses itself in one place", pulled_through(), a_overlaps, b_overlaps},
          {"crosses itself all over", shapes::torus(24, 12, 0.5, 0.8), a_overlaps, b_overlaps},
          {"components that overlap", shapes::several({ball, shapes::translated(ball, {0.7, 0.1, 0.2})}),
           a_overlaps, b_overlaps},
          {"components in one place", shapes::several({ball, ball}), a_overlaps, b_overlaps},
          {"components that touch in a face",
           shapes::several(
               {shapes::box({-1, -0.5, -0.5}, {0, 0.5, 0.5}), shapes::box({0, -0.5, -0.5}, {1, 0.5, 0.5})}),
           none, none},
          {"open", shapes::open_cylinder(12), a_open, b_open, false},
          {"a void", hollow, none, none},
          {"a body in a void", shapes::several({hollow, shapes::icosphere(1, 0.3)}), none, none}};
}

/// Returns the body through every door there is.
std::vector<Body> through_all_doors(const Mesh& mesh, const test::Folder& folder) {
  BodyOptions plain;
  plain.regions = false;
  write_mesh(mesh, folder / "mesh.obj");
  std::vector<Body> bodies = {Body::from(mesh).value(), Body::from(mesh, plain).value(),
                              Body::load(folder / "mesh.obj").value(),
                              Body::load(folder / "mesh.obj", plain).value()};
  for (const char* const name : {"built.lrb", "plain.lrb"}) {
    save_lrb(bodies[name[0] == 'b' ? 0 : 1].rep(), folder / name);
    bodies.push_back(Body::load(folder / name).value());
  }
  bodies.push_back(Body::from(LrbRep::without_regions(mesh, bodies[0].is_solid(), false)));
  bodies.push_back(Body::from(LrbRep::without_regions(mesh, bodies[0].is_solid(), true)));
  return bodies;
}

void check_equal(const std::optional<ProvedInterval>& x, const std::optional<ProvedInterval>& y) {
  REQUIRE(x.has_value() == y.has_value());
  if (x) CHECK(std::pair(x->lower, x->upper) == std::pair(y->lower, y->upper));
}

void check_same(const ClashResult& x, const ClashResult& y) {
  CHECK(x.kind == y.kind);
  CHECK(x.reason == y.reason);
  CHECK(x.shares_faces == y.shares_faces);
  CHECK(x.interiors_overlap == y.interiors_overlap);
  check_equal(x.distance, y.distance);
  check_equal(x.depth, y.depth);
  check_equal(x.volume, y.volume);
  CHECK(x.translation == y.translation);
}

}  // namespace

TEST_CASE("B2: clash gives the same answer through every interface, with a reason if undecided") {
  const test::Folder folder;
  const LrbRep cube = Body::from(shapes::box({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4})).value().rep();
  const Pose apart = Pose::translation({9, 0, 0}), meeting = Pose::translation({0.93, 0.11, 0.07});
  for (const Row& row : rows()) {
    CAPTURE(row.name);
    const std::vector<Body> bodies = through_all_doors(row.mesh, folder);
    const ClashResult first = clash(bodies[0], Pose{}, cube, meeting);
    const ClashResult swapped = clash(cube, meeting, bodies[0], Pose{});
    CHECK(first.reason == row.as_a);
    CHECK(swapped.reason == row.as_b);
    CHECK((first.kind == ClashKind::undecided) == (row.as_a != ClashReason::none));
    CHECK((swapped.kind == ClashKind::undecided) == (row.as_b != ClashReason::none));
    CHECK(first.volume.has_value() == (row.as_a == ClashReason::none));
    CHECK(first.depth.has_value() == row.closed);
    if (first.depth)
      CHECK(collide(bodies[0], Pose{}, cube, Pose{meeting.r, meeting.t + first.translation}).relation ==
            Relation::separate);
    for (const Body& body : bodies) {
      check_same(clash(body, Pose{}, cube, meeting), first);
      check_same(clash(cube, meeting, body, Pose{}), swapped);
      const ClashResult far = clash(body, Pose{}, cube, apart);
      CHECK(far.kind == ClashKind::apart);
      CHECK(far.reason == ClashReason::none);
      CHECK(far.interiors_overlap == Answer::no);
    }
  }
}

TEST_CASE("B2: a clash of 2D bodies is rejected through every interface") {
  const test::Folder folder;
  for (const Body& body : through_all_doors(shapes::circle(12), folder))
    CHECK_THROWS_WITH_AS(clash(body, Pose{}, body, Pose{}), doctest::Contains("expected 3D bodies"),
                         InputError);
}

TEST_CASE("B2: overlap of interiors is the same through every interface") {
  const test::Folder folder;
  const Mesh mesh = shapes::several({shapes::box(), shapes::box({0.5, 0.25, 0.25}, {2, 0.75, 0.75})});
  const LrbRep cube = Body::from(shapes::box({2, 0, 0}, {3, 1, 1})).value().rep();
  CollideRequest request;
  request.interiors_overlap = true;
  for (const Body& body : through_all_doors(mesh, folder)) {
    const CollideResult found = collide(body, Pose{}, cube, Pose{}, request);
    CHECK(found.relation == Relation::touching);
    CHECK(found.interiors_overlap == Answer::unknown);
  }
}
