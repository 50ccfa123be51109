// Approaches: the step of first contact, and that nothing is passed through between two steps.
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "scenarios/spec/motion.hpp"
#include <lrbscope/collide.hpp>

using namespace lrb;

namespace {

spec::Motion coming(double step_length) {
  spec::Motion m;
  m.kind = spec::Motion::Kind::approach;
  m.from = {0, 0, 3.3};
  m.step_length = step_length;
  m.steps = 1000;
  m.before = 3;
  m.into = 2;
  return m;
}

const LrbRep& box() {
  static const LrbRep rep = LrbRep::without_regions(shapes::box(), true, false);
  return rep;
}

Relation relation_at(const LrbRep& a, const Pose& pose) {
  return collide(a, Pose{}, box(), pose).relation;
}

}  // namespace

TEST_CASE("approach: whole steps, the first in contact") {
  const spec::Approach found = spec::find_approach(box(), {}, box(), {}, coming(0.05));
  REQUIRE(found.met);
  REQUIRE(found.poses.size() == 6);
  CHECK(found.first_contact == 3);
  CHECK(relation_at(box(), found.poses[2]) == Relation::separate);
  CHECK(relation_at(box(), found.poses[3]) != Relation::separate);
  // Boxes of 1 meet at z = 1.
  REQUIRE(found.search.step.has_value());
  const double moved = found.poses[0].t.z() - 1, steps = moved / (0.05 * 2 * std::sqrt(3.0));
  CHECK(found.search.step->at(0) <= steps + 1e-12);
  CHECK(found.search.step->at(1) >= steps - 1e-12);
  CHECK(found.search.step->at(1) - found.search.step->at(0) < 1e-7);
  CHECK(found.search.length->at(1) == doctest::Approx(moved));
}

TEST_CASE("approach: a step at the first contact itself") {
  spec::Motion motion = coming(0.05);
  motion.exact = true;
  motion.degrees = 3;
  const spec::Approach found = spec::find_approach(box(), {}, box(), {}, motion);
  REQUIRE(found.met);
  REQUIRE(found.poses.size() == 6);
  CHECK(found.first_contact == 3);
  CHECK(relation_at(box(), found.poses[2]) == Relation::separate);
  CHECK(relation_at(box(), found.poses[3]) != Relation::separate);
  CHECK(found.poses[3].t.z() == doctest::Approx(1));
  CHECK(found.poses[3].t.z() <= 1);
  CHECK((found.poses[3].t - found.poses[2].t).norm() == doctest::Approx(0.05 * 2 * std::sqrt(3.0)));
  CHECK(found.search.step->at(1) == 3);
  CHECK(found.search.length->at(1) == doctest::Approx(found.poses[0].t.z() - 1));
}

TEST_CASE("approach: a sheet between two steps is detected") {
  Mesh mesh;
  mesh.vertices = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  mesh.add_face(std::array<VertexId, 4>{0, 1, 2, 3});
  const LrbRep sheet = LrbRep::without_regions(mesh, false, false);
  spec::Motion motion = coming(0.1);
  motion.from = {0, 0, 7};
  // Steps of 2.7 and a box of 1: one step ends 1.5 before the sheet, and the next 0.2 behind it.
  const spec::Approach found = spec::find_approach(sheet, {}, box(), {}, motion);
  REQUIRE(found.met);
  CHECK(relation_at(sheet, found.poses[found.first_contact]) != Relation::undefined);
}

TEST_CASE("approach: nested bodies collide at once; bodies that miss do not") {
  const LrbRep large = LrbRep::without_regions(shapes::box({-9, -9, -9}, {9, 9, 9}), true, false);
  const spec::Approach inside = spec::find_approach(large, {}, box(), {}, coming(0.05));
  CHECK(inside.met);
  CHECK(inside.first_contact == 0);
  spec::Motion past = coming(0.05);
  past.target = {5, 0, 0};
  const spec::Approach missed = spec::find_approach(box(), {}, box(), {}, past);
  CHECK(!missed.met);
  CHECK(!missed.search.step.has_value());
  CHECK(missed.poses.size() > 5);
}

// It was counted from the start of the approach, of which a run records the end alone.
TEST_CASE("approach: the first contact is a recorded step") {
  const spec::Approach found = spec::find_approach(box(), {}, box(), {}, coming(0.05));
  REQUIRE(found.search.step.has_value());
  CHECK(found.search.step->at(0) > found.first_contact - 1);
  CHECK(found.search.step->at(1) <= found.first_contact);
  CHECK(spec::contact_step(found.search) == "step 2.28");
  CHECK(spec::contact_way(found.search) == "after B has moved 0.3947441 from step 0");
  spec::Motion late = coming(0.05);
  late.before = 0;
  const spec::Approach after = spec::find_approach(box(), {}, box(), {}, late);
  CHECK(after.search.step->at(1) == doctest::Approx(found.search.step->at(1) - 3));
  CHECK(spec::contact_step(after.search) == "0.72 steps before step 0");
  CHECK(spec::contact_way(after.search) == "B moves 0.1248711 from there until step 0");
}
