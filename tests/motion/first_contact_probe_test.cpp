// Reports of a first contact search to a probe.
#include <cmath>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/answer_content.hpp"
#include <lrbscope/first_contact.hpp>

using namespace lrb;
using Eigen::Vector3d;

namespace {

/// Searches with a probe, and checks the invariants of all reports.
std::vector<ContactBounds> history_of(const LrbRep& a, const LrbRep& b, const Motion& motion,
                                      FirstContactResult& watched, const FirstContactRequest& request = {}) {
  FirstContactHistory reported;
  watched = first_contact(a, Motion::still({}), b, motion, request, reported);
  const FirstContactResult plain = first_contact(a, Motion::still({}), b, motion, request);
  CHECK((test::content(watched) == test::content(plain)));
  ContactBounds before;
  for (const ContactBounds& now : reported.history) {
    CAPTURE(now.t0);
    CHECK(now.work >= before.work);
    CHECK(now.t0 >= before.t0);
    CHECK(now.t1 <= before.t1);
    DistanceRequest rough;
    const DistanceResult there = distance(a, {}, b, motion.at(now.t0), rough);
    CHECK(now.lower <= there.upper);
    CHECK(now.upper >= there.lower);
    CHECK(now.upper - now.lower <= 0.011 * now.upper + 1e-13);
    if (now.t0 < watched.t0) CHECK(now.lower > 0);
    before = now;
  }
  return reported.history;
}

}  // namespace

TEST_CASE("first contact probe: t0 rises and t1 falls to the answer, with the distance on the way") {
  const LrbRep ball = LrbRep::without_regions(shapes::icosphere(3), true, false);
  for (const double aside : {0.0, 0.7, 1.7}) {
    CAPTURE(aside);
    FirstContactResult result;
    const Motion motion =
        Motion::turning(Pose::translation({5, aside, 0.1}), {0, 0, 0.9}, {5, aside, 0.1}, {-10, 0, 0});
    const std::vector<ContactBounds> history = history_of(ball, ball, motion, result);
    REQUIRE(result.is_contact());
    REQUIRE(history.size() >= 3);
    CHECK(history.front().t0 == 0);
    CHECK(history.front().lower == doctest::Approx(std::hypot(5, aside) - 2).epsilon(0.05));
    CHECK(std::isinf(history.front().t1));
    CHECK(history.back().t0 == result.t0);
    CHECK(history.back().t1 == result.t1);
  }
}

TEST_CASE("first contact probe: bodies that never collide, and bodies that start in contact") {
  const LrbRep ball = LrbRep::without_regions(shapes::icosphere(2), true, false);
  FirstContactResult result;
  const std::vector<ContactBounds> passing =
      history_of(ball, ball, Motion::linear(Pose::translation({5, 2.5, 0}), {-5, 2.5, 0}), result);
  REQUIRE(result.outcome == MotionOutcome::never);
  CHECK(passing.back().t0 == 1);
  CHECK(std::isinf(passing.back().t1));
  const std::vector<ContactBounds> met =
      history_of(ball, ball, Motion::linear(Pose::translation({1, 0, 0}), {-5, 0, 0}), result);
  REQUIRE(met.size() == 1);
  CHECK(met[0].t1 == 0);
  CHECK(met[0].upper == 0);
}

TEST_CASE("first contact probe: poses other than rotations are searched by distances, and reported") {
  const LrbRep ball = LrbRep::without_regions(shapes::icosphere(2), true, false);
  Pose start;
  start.r = Vector3d(1, 0.5, 2).asDiagonal();
  start.t = {6, 0.1, 0.2};
  FirstContactResult result;
  const std::vector<ContactBounds> history =
      history_of(ball, ball, Motion::linear(start, {-6, 0.1, 0.2}), result);
  REQUIRE(result.is_contact());
  CHECK(history.size() >= 3);
  CHECK(history.back().t1 == result.t1);
}
