// First contacts against rational arithmetic, against what is known in closed form, and against fine
// sampling.
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/rational.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/random.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>

using namespace lrb;
using Eigen::Vector3d;
using oracle::Rational;
using shapes::RandomEngine;

namespace {

constexpr double kPi = std::numbers::pi;

using test::closed;

bool meet(const LrbRep& a, const Motion& motion_a, const LrbRep& b, const Motion& motion_b, double t) {
  CollideRequest any;
  any.mode = Mode::any_pair;
  return !collide(a, motion_a.at(t), b, motion_b.at(t), any).pairs.empty();
}

const Motion kStill = Motion::still({});

/// Checks what any result promises, with the exact query at many times; an interval as narrow as asked,
/// unless it grazes.
FirstContactResult checked(const LrbRep& a, const Motion& motion_a, const LrbRep& b, const Motion& motion_b,
                           const FirstContactRequest& request = {}, int samples = 60) {
  const FirstContactResult r = first_contact(a, motion_a, b, motion_b, request);
  for (int i = 0; i < samples; ++i) {
    const double close = 1 - std::pow(10, -16.0 * i / samples);
    for (const double t : {r.t0 * i / samples, r.t0 * close}) {
      CAPTURE(t);
      if (t < r.t0) REQUIRE(!meet(a, motion_a, b, motion_b, t));
    }
  }
  if (!r.is_contact()) return r;
  if (!r.passed) REQUIRE(meet(a, motion_a, b, motion_b, r.t1));
  if (!r.grazing) REQUIRE(r.t1 - r.t0 <= request.tolerance);
  REQUIRE(r.at_start == (r.t1 == 0));
  if (r.passed) return r;
  const std::vector<lrb::SimplexPair> pairs = collide(a, motion_a.at(r.t1), b, motion_b.at(r.t1)).pairs;
  REQUIRE(std::binary_search(pairs.begin(), pairs.end(), r.pair));
  return r;
}

/// The exact time of first contact of B that moves straight from a pose whose matrix is the identity and
/// whose way are doubles; none if they do not meet.
std::optional<Rational> exact_time(const LrbRep& a, const LrbRep& b, const Vector3d& from,
                                   const Vector3d& way) {
  std::optional<Rational> first;
  for (SimplexId s = 0; s < a.real_simplex_count(); ++s)
    for (SimplexId t = 0; t < b.real_simplex_count(); ++t) {
      // Boxes that do not meet on the way spare the oracle's time.
      Eigen::AlignedBox3d box_a, box_b;
      for (const Vector3d& x : test::simplex_points(a, Pose{}, s)) box_a.extend(x);
      for (const Vector3d& x : test::simplex_points(b, Pose::translation(from), t)) {
        box_b.extend(x);
        box_b.extend(Vector3d(x + (first ? first->convert_to<double>() + 1e-9 : 1) * way));
      }
      if (!box_a.intersects(box_b)) continue;
      const auto time = oracle::first_time(test::simplex_points(a, Pose{}, s),
                                           test::simplex_points(b, Pose::translation(from), t), way,
                                           first ? *first : Rational(1));
      if (time && (!first || *time < *first)) first = time;
    }
  return first;
}

/// Returns coordinates with few digits, so that the sum of two of them is a double.
Vector3d rounded(const Vector3d& x) {
  return (x * 1024).array().round() / 1024;
}

}  // namespace

TEST_CASE("a motion is the function documented in its header") {
  RandomEngine random(1);
  for (int i = 0; i < 40; ++i) {
    const Pose start{shapes::random_rotation(random), shapes::random_direction(random)};
    const Pose end{shapes::random_rotation(random), 3 * shapes::random_direction(random)};
    const Motion screw = Motion::screw(start, end);
    CHECK(screw.at(0).r == start.r);
    CHECK(screw.at(0).t == start.t);
    CHECK((screw.at(1).r - end.r).norm() < 1e-14);
    CHECK((screw.at(1).t - end.t).norm() < 1e-14);
    // R(t) = R0 exp(t log(R0^T R1)): equal steps are equal rotations.
    const Pose third = screw.at(0.25), half = screw.at(0.5);
    CHECK((start.r.transpose() * third.r - third.r.transpose() * half.r).norm() < 1e-14);
    const Eigen::AngleAxisd whole(Eigen::Matrix3d(start.r.transpose() * end.r)),
        part(Eigen::Matrix3d(start.r.transpose() * third.r));
    CHECK(part.angle() == doctest::Approx(0.25 * whole.angle()));
    CHECK((third.t - (0.75 * start.t + 0.25 * end.t)).norm() < 1e-14);
  }
  // Turns about a point that moves: 100 turns and a quarter.
  const Motion spin =
      Motion::turning(Pose::translation({2, 0, 0}), {0, 0, 200.5 * kPi}, {1, 0, 0}, {0, 0, 4});
  CHECK((spin.at(1).t - Vector3d(1, 1, 4)).norm() < 1e-12);
  CHECK((spin.at(0).apply({0, 0, 0}) - Vector3d(2, 0, 0)).norm() == 0);
  const Motion keys = Motion::key_frames(std::array<Motion::KeyFrame, 3>{
      {{0, Pose{}}, {0.25, Pose::rotation({0, 0, 1}, 1)}, {1, Pose::translation({1, 0, 0})}}});
  CHECK((keys.at(0.25).r - deterministic::rotation({0, 0, 1}, 1)).norm() < 1e-15);
  CHECK((keys.at(0.625).r - deterministic::rotation({0, 0, 1}, 0.5)).norm() < 1e-15);
  CHECK((keys.at(0.625).t - Vector3d(0.5, 0, 0)).norm() < 1e-15);
}

TEST_CASE("straight motions: the interval contains the rational time of first contact") {
  RandomEngine random(2);
  const LrbRep bodies[] = {closed(shapes::tetrahedron()),
                           closed(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.75, 0.5})),
                           closed(shapes::icosphere(0, 0.75)), closed(shapes::comb(2))};
  int contacts = 0, never = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const LrbRep &a = bodies[i % 4], &b = bodies[i / 4 % 4];
    const Vector3d from = rounded(4 * shapes::random_direction(random));
    const Vector3d way = rounded(std::pow(10, i % 4) * (shapes::random_direction(random) - from));
    // B's corners keep their digits, too: only the way to the contact is rounded.
    const Motion motion = Motion::linear(Pose::translation(from), from + way);
    REQUIRE((from + way) - from == way);
    const FirstContactResult r = checked(a, kStill, b, motion);
    const auto time = exact_time(a, b, from, way);
    REQUIRE(r.outcome == (time ? MotionOutcome::contact : MotionOutcome::never));
    contacts += time.has_value();
    never += !time.has_value();
    if (!time) continue;
    CAPTURE(time->convert_to<double>());
    CAPTURE(r.t0);
    CAPTURE(r.t1);
    CHECK(Rational(r.t0) <= *time);
    CHECK(Rational(r.t1) >= *time - Rational(1e-14));
    CHECK(r.t1 - r.t0 <= 1e-9);
    CHECK(!r.grazing);
  }
  CHECK(contacts > 20);
  CHECK(never > 5);
}

TEST_CASE("boxes: face to face, edge to edge and corner to face, at known times") {
  const LrbRep box = closed(shapes::quad_box());
  const auto expect = [&](const Motion& motion, double time) {
    const FirstContactResult r = checked(box, kStill, box, motion);
    REQUIRE(r.is_contact());
    CHECK(r.t0 <= time);
    CHECK(r.t1 >= time - 1e-14);
    CHECK(r.t1 - r.t0 <= 1e-9);
    return r;
  };
  FirstContactResult r = expect(Motion::linear(Pose::translation({3, 0.25, 0.25}), {-1, 0.25, 0.25}), 0.5);
  CHECK((r.normal - Vector3d(1, 0, 0)).norm() < 1e-9);
  CHECK(r.speed == doctest::Approx(4));
  CHECK(r.at_begin == Relation::separate);
  r = expect(Motion::linear(Pose::translation({4, 0, 0}), {-5, 0, 0}), 1.0 / 3);  // flush, and no double
  CHECK(r.speed == doctest::Approx(9));
  // B, balanced on a corner, descends on A's upper face.
  const Eigen::Matrix3d tip =
      deterministic::rotation(Vector3d(1, -1, 0).normalized(), std::atan(std::sqrt(2.0)));
  const double lowest = (tip * Vector3d(0, 0, 0)).z();
  r = expect(Motion::linear({tip, {0.7, 0.4, 3}}, {0.7, 0.4, -1}), (2 + lowest) / 4);
  CHECK((r.normal - Vector3d(0, 0, 1)).norm() < 1e-9);
  CHECK(r.speed == doctest::Approx(4));
  CHECK(r.witness[0].feature.dim == 2);
  CHECK(r.witness[1].feature.dim == 0);
  // Two bars on their edges, across each other: the upper edge of one is at z = 1 / sqrt(2), as is the lower
  // of the other.
  const LrbRep bar = closed(shapes::quad_box({-0.5, -5, -0.5}, {0.5, 5, 0.5}));
  const Eigen::Matrix3d on_edge = deterministic::rotation({0, 1, 0}, kPi / 4);
  const Pose lies{on_edge, {0, 0, 0}}, crosses{deterministic::rotation({0, 0, 1}, 1) * on_edge, {0, 0, 4}};
  r = checked(bar, Motion::still(lies), bar, Motion::linear(crosses, {0, 0, 0}));
  REQUIRE(r.is_contact());
  CHECK(r.t0 <= 1 - std::sqrt(2.0) / 4 + 1e-15);
  CHECK(r.t1 >= 1 - std::sqrt(2.0) / 4 - 1e-15);
  CHECK(r.witness[0].feature.dim == 1);
  CHECK(r.witness[1].feature.dim == 1);
  CHECK((r.normal - Vector3d(0, 0, 1)).norm() < 1e-6);
}

TEST_CASE("rotating bodies: at known times, for any number of revolutions") {
  // The blade's end goes round, from (1, 0), and meets the knife, none of which is lower, at y = 0.5: after
  // pi / 6.
  const LrbRep blade = closed(shapes::quad_box({0, -0.25, -1}, {1, 0, 1}));
  const LrbRep knife = closed(shapes::translated(shapes::tetrahedron(0.5), {0.5, 0.5, 0}));
  for (const double turns : {0.25, 1.0, 100.25, 1000.0}) {
    CAPTURE(turns);
    const FirstContactResult r =
        checked(knife, kStill, blade, Motion::turning({}, {0, 0, 2 * kPi * turns}, {0, 0, 0}, {0, 0, 0}));
    REQUIRE(r.is_contact());
    const double time = 1 / (12 * turns);
    CHECK(r.t0 <= time * (1 + 1e-15));
    CHECK(r.t1 >= time * (1 - 1e-15));
    CHECK(r.t1 - r.t0 <= 1e-9);
    CHECK(r.speed == doctest::Approx(2 * kPi * turns * std::cos(kPi / 6)));
  }
  // The other way round, and missed by a little more than the blade is long.
  const LrbRep further = closed(shapes::translated(shapes::tetrahedron(0.5), {0.75, 0.75, 0}));
  CHECK(checked(further, kStill, blade, Motion::turning({}, {0, 0, -2000}, {0, 0, 0}, {0, 0, 0})).outcome ==
        MotionOutcome::never);
}

TEST_CASE("no sheet is tunnelled through, at any speed, parallel or not") {
  RandomEngine random(5);
  const auto sheet = [](double half) {
    return test::open_body(test::sheet(1, {-half, -half}, {half, half}));
  };
  const LrbRep a = sheet(1), b = sheet(0.75), same = sheet(1);
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const double speed = std::pow(10, i % 12);
    const bool parallel = i % 2 == 0;
    const Vector3d aside = i % 3 == 0 ? Vector3d(0, 0, 0) : Vector3d(0.3 * shapes::random_direction(random));
    Pose start = Pose::translation(aside + Vector3d(0, 0, 0.3 * speed));
    if (!parallel) start.r = deterministic::rotation(shapes::random_direction(random), 0.001);
    const Motion through = Motion::linear(start, aside - Vector3d(0, 0, 0.7 * speed));
    const FirstContactResult r = checked(a, kStill, i % 4 < 2 ? b : same, through);
    CHECK(r.is_contact());
    const double time = 0.3 + aside.z() / speed, off = parallel ? 1e-15 : 0.004 / speed;
    CHECK(r.t0 <= time + off);
    CHECK(r.t1 >= time - off);
    CHECK(r.t1 - r.t0 <= 1e-9);
  }
}

TEST_CASE("contact at the start is reported, and an enclosed body is not in contact") {
  const LrbRep box = closed(shapes::quad_box()), small = closed(shapes::scaled(shapes::icosphere(1), 0.2));
  FirstContactResult r =
      first_contact(box, kStill, box, Motion::linear(Pose::translation({1, 0, 0}), {5, 0, 0}));
  CHECK(r.is_contact());
  CHECK(r.at_start);
  CHECK(r.t0 == 0);
  CHECK(r.t1 == 0);
  CHECK(r.at_begin == Relation::touching);
  const Motion stays = Motion::linear(Pose::translation({0.4, 0.5, 0.5}), {0.6, 0.5, 0.5});
  r = checked(box, kStill, small, stays);
  CHECK(r.outcome == MotionOutcome::never);
  CHECK(r.at_begin == Relation::b_inside_a);
  r = checked(box, kStill, small, Motion::linear(Pose::translation({0.4, 0.5, 0.5}), {3, 0.5, 0.5}));
  CHECK(r.is_contact());
  CHECK(r.at_begin == Relation::b_inside_a);
  CHECK(r.t1 < 0.2);
}

TEST_CASE("tangential contacts have a wider interval and are marked as grazing") {
  const LrbRep box = closed(shapes::quad_box());
  // Flush in doubles: both slide along the plane z = 1 and touch from t = 0.5 on.
  FirstContactResult r =
      checked(box, kStill, box, Motion::linear(Pose::translation({3, 0.25, 1}), {-1, 0.25, 1}));
  REQUIRE(r.is_contact());
  CHECK(r.t0 <= 0.5);
  CHECK(r.t1 >= 0.5);
  CHECK(r.t1 - r.t0 <= 1e-9);
  // Above it by less than rounding: undecided from the time on when edges are above each other.
  r = checked(box, kStill, box,
              Motion::linear(Pose::translation({3, 0.25, 1 + 1e-15}), {-1, 0.25, 1 + 1e-15}));
  CHECK(r.outcome == MotionOutcome::undecided);
  CHECK(r.grazing);
  CHECK(r.t0 == doctest::Approx(0.5));
  CHECK(r.t1 == doctest::Approx(1));
  // Above it by a little more: they do not meet.
  r = checked(box, kStill, box,
              Motion::linear(Pose::translation({3, 0.25, 1 + 1e-12}), {-1, 0.25, 1 + 1e-12}));
  CHECK(r.outcome == MotionOutcome::never);
  // Grazes a corner with a corner, and meets a wall later.
  const LrbRep wall =
      closed(shapes::several({shapes::quad_box(), shapes::quad_box({-10, -5, -5}, {-9, 5, 5})}));
  r = checked(wall, kStill, box,
              Motion::linear(Pose::translation({3, 0.25, 1 + 1e-15}), {-13, 0.25, 1 + 1e-15}));
  REQUIRE(r.is_contact());
  CHECK(r.grazing);
  CHECK(r.ambiguous.size() == 1);
  CHECK(r.t0 == doctest::Approx(2.0 / 16));
  CHECK(r.t1 == doctest::Approx(12.0 / 16));
}

TEST_CASE("both bodies move: the same as one of them in the other's frame") {
  RandomEngine random(7);
  const LrbRep a = closed(shapes::bumpy_sphere(2, 5)), b = closed(shapes::torus(12, 9));
  int contacts = 0;
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    const Vector3d d = 6 * shapes::random_direction(random), drift = shapes::random_direction(random);
    const Pose start{shapes::random_rotation(random), d};
    const Motion one = Motion::linear(start, -d), shifted = Motion::linear(start, drift - d);
    const FirstContactResult alone = checked(a, kStill, b, one);
    const FirstContactResult both = checked(a, Motion::linear({}, drift), b, shifted);
    REQUIRE(alone.outcome == both.outcome);
    CHECK(alone.t0 == doctest::Approx(both.t0).epsilon(1e-8));
    const Motion turning = Motion::turning({}, 5 * shapes::random_direction(random), {0, 0, 0}, {0, 0, 0});
    contacts += checked(a, turning, b, one).is_contact();
  }
  CHECK(contacts > 10);
}

TEST_CASE("scaled, mirrored and 2D bodies") {
  RandomEngine random(8);
  const LrbRep a = closed(shapes::icosphere(1)), b = closed(shapes::torus(8, 6));
  for (int i = 0; i < 6; ++i) {
    Pose start = Pose::translation(6 * shapes::random_direction(random));
    start.r = shapes::random_rotation(random) * (i % 2 == 0 ? 1.5 : -1.0);
    const FirstContactResult r = checked(a, kStill, b, Motion::linear(start, -start.t));
    CHECK(r.is_contact());
    CHECK(!r.grazing);
  }
  const LrbRep gear = closed(shapes::gear(12)), star = closed(shapes::star(5));
  for (int i = 0; i < 12; ++i) {
    Vector3d d = shapes::random_direction(random);
    d.z() = 0;
    d *= 4 / d.norm();
    const Motion spin = Motion::turning(Pose::translation(d), {0, 0, 10}, d, -2 * d);
    const FirstContactResult r = checked(gear, kStill, star, spin);
    CHECK(r.is_contact());
    CHECK(r.t1 - r.t0 <= 1e-9);
  }
}

TEST_CASE("a tolerance only widens the interval, and a budget keeps proven bounds") {
  RandomEngine random(9);
  const LrbRep a = closed(shapes::bumpy_sphere(3, 5)), b = closed(shapes::torus(24, 16));
  for (int i = 0; i < 12; ++i) {
    CAPTURE(i);
    const Pose start{shapes::random_rotation(random), 5 * shapes::random_direction(random)};
    const Motion motion =
        Motion::screw(start, {shapes::random_rotation(random), 0.2 * shapes::random_direction(random)});
    const FirstContactResult one = first_contact(a, kStill, b, motion);
    for (const double tolerance : {1e-2, 1e-5, 1e-12}) {
      const FirstContactResult r = checked(a, kStill, b, motion, {.tolerance = tolerance}, 10);
      REQUIRE(r.outcome == one.outcome);
      if (!r.is_contact()) continue;
      CHECK(r.t1 - r.t0 <= tolerance);
      CHECK(r.t0 <= one.t1);
      CHECK(r.t1 >= one.t0);
    }
    for (std::uint64_t steps = 1; steps < 1000; steps *= 4) {
      const FirstContactResult r = checked(a, kStill, b, motion, {.max_steps = steps, .history = true}, 10);
      CHECK(r.t0 <= one.t1);
      CHECK((r.finished || r.outcome == MotionOutcome::undecided));
      if (r.finished) CHECK(r.outcome == one.outcome);
      for (std::size_t k = 1; k < r.history.size(); ++k)
        CHECK(r.history[k].free_until >= r.history[k - 1].free_until);
    }
  }
}

TEST_CASE("invalid motions are rejected") {
  Pose sheared;
  sheared.r(0, 1) = 0.5;
  CHECK_THROWS_AS(Motion::screw({}, sheared), InputError);
  CHECK_THROWS_AS(Motion::screw(sheared, {}), InputError);
  CHECK_NOTHROW(Motion::screw(sheared, {sheared.r, {1, 2, 3}}));
  Pose mirrored;
  mirrored.r(0, 0) = -1;
  CHECK_THROWS_AS(Motion::screw({}, mirrored), InputError);
  CHECK_THROWS_AS(Motion::linear({}, {INFINITY, 0, 0}), InputError);
  CHECK_THROWS_AS(Motion::key_frames({}), InputError);
  CHECK_THROWS_AS(Motion::key_frames(std::array<Motion::KeyFrame, 2>{{{0, {}}, {0.5, {}}}}), InputError);
  CHECK_THROWS_AS(Motion::key_frames(std::array<Motion::KeyFrame, 3>{{{0, {}}, {0.5, {}}, {0.5, {}}}}),
                  InputError);
}
