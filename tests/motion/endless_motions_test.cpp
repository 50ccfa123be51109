// Motions and tolerances for which searches for a first contact did not end, or took thousands of times as
// long as others.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/first_contact.hpp>

using namespace lrb;
using Eigen::Vector3d;

namespace {

using test::closed;

const Motion kAtRest = Motion::still({});

LrbRep grid(std::uint32_t n) {
  return test::open_body(test::sheet(n, {-1, -1}, {1, 1}));
}

Motion slide(const Vector3d& from, const Vector3d& to, double size = 1) {
  return Motion::linear({size * Eigen::Matrix3d::Identity(), from}, to);
}

Motion spin_above(double gap, double turns = 1) {
  return Motion::turning(Pose::translation({0, 0, gap}), {0, 0, 2 * std::numbers::pi * turns}, {0, 0, 0},
                         {0, 0, 0});
}

std::uint64_t work_of(const FirstContactResult& r) {
  const FirstContactCounters& k = r.counters;
  return k.spans + k.pairs + k.steps + k.exact_queries;
}

/// Asks, and checks what any result promises, and that it took no more than first_contact.hpp says, with room
/// for the last span.
FirstContactResult ended(const LrbRep& a, const LrbRep& b, const Motion& motion, double tolerance = 1e-9) {
  FirstContactRequest request;
  request.tolerance = tolerance;
  request.max_steps = 0;
  const FirstContactResult r = first_contact(a, kAtRest, b, motion, request);
  double turns = 0;
  for (const Motion::Piece& p : motion.pieces())
    turns += std::min(p.turn.norm() / (2 * std::numbers::pi), 16.0);
  const double simplices = a.real_simplex_count() + b.real_simplex_count();
  const double parts = 0.5 + 0.5 * static_cast<double>(motion.pieces().size()) + turns;
  CHECK(static_cast<double>(work_of(r)) <= (8192 + 512 * simplices) * parts * 1.05);
  CHECK(r.t0 <= r.t1);
  const bool wide = r.outcome == MotionOutcome::undecided || (r.is_contact() && r.t1 - r.t0 > tolerance);
  CHECK(wide == (r.unresolved != Unresolved::nothing));
  CHECK(r.finished == (r.unresolved != Unresolved::steps));
  CollideRequest any;
  any.mode = Mode::any_pair;
  if (r.is_contact() && !r.passed) CHECK(!collide(a, {}, b, motion.at(r.t1), any).pairs.empty());
  if (r.t0 > 0) CHECK(collide(a, {}, b, motion.at(std::nextafter(r.t0, 0)), any).pairs.empty());
  return r;
}

}  // namespace

TEST_CASE("the search for a sliding scaled body ends") {
  const LrbRep box = closed(shapes::quad_box());
  // It went on by its gap at a time.
  const FirstContactResult r = ended(box, box, slide({3, 0.25, 1 + 1e-6}, {-3, 0.25, 1 + 1e-6}, 2));
  CHECK(r.outcome == MotionOutcome::never);
  CHECK(work_of(r) < 20'000);
  for (const double gap : {1e-12, 1e-15})
    ended(box, box, slide({3, 0.25, 1 + gap}, {-3, 0.25, 1 + gap}, 2), 1e-15);
}

TEST_CASE("the search for a sheet that slides or rotates in its own plane ends") {
  const LrbRep one = grid(1), fine = grid(8);
  for (const LrbRep* sheet : {&one, &fine})
    for (const double gap : {0.0, 5e-324, 1e-17, 1e-15, 1e-14, 1e-13}) {
      CAPTURE(gap);
      ended(*sheet, *sheet, slide({3, 0.25, gap}, {-1, 0.25, gap}));
      ended(*sheet, *sheet, spin_above(gap));
    }
  // It went on by the root of its gap at a time.
  for (const double gap : {1e-12, 1e-10, 1e-8}) {
    CAPTURE(gap);
    const FirstContactResult r = ended(one, one, spin_above(gap));
    CHECK(r.outcome == MotionOutcome::never);
    CHECK(work_of(r) < 5000);
  }
}

TEST_CASE("the search ends for any tolerance and degenerate motion") {
  const LrbRep box = closed(shapes::quad_box()), ball = closed(shapes::icosphere(1));
  const Motion screw = Motion::screw(Pose::rotation(Vector3d(1, 2, 3).normalized(), 0.4, {3, 0.3, 0.2}),
                                     Pose::rotation(Vector3d(1, -2, 3).normalized(), 1.4, {-0.5, 0.1, 0.2}));
  const std::uint64_t ordinary = work_of(ended(box, box, screw));
  for (const double tolerance :
       {1e-12, 1e-15, 1e-16, 1e-17, 1e-30, 1e-300, std::numeric_limits<double>::denorm_min()}) {
    CAPTURE(tolerance);
    const Motion motions[] = {
        slide({3, 0.25, 0.25}, {-1, 0.25, 0.25}),
        slide({3, 0.3, 0.2}, {-0.7, 0.11, 0.13}),
        slide({3, 0.25, 0.25}, {1, 0.25, 0.25}),
        slide({3, 0.25, 0.25}, {1 + 1e-15, 0.25, 0.25}),
        slide({3, 0.25, 0.25}, {1 + 1e-13, 0.25, 0.25}),
        slide({1 + 1e-9, 0.25, 0.25}, {1, 0.25, 0.25}),
        slide({3, 0.25, 1 + 1e-15}, {-1, 0.25, 1 + 1e-15}),
        slide({3, 0.25, 1 + 2e-14}, {-1, 0.25, 1 + 2e-14}),
        kAtRest,
        Motion::still(Pose::translation({1 + 1e-15, 0, 0})),
        Motion::still(Pose::translation({2, 0, 0})),
        Motion::turning(Pose::translation({1, 1, 1}), {0, 0, 3}, {1, 1, 1}, {0, 0, 0}),
        Motion::turning(Pose::translation({1 + 1e-15, 1, 1}), {0, 1, 3}, {1, 1, 1}, {0, 0, 0}),
        Motion::screw({}, Pose::rotation({0, 0, 1}, 1, {2, 0, 0}))};
    for (const Motion& motion : motions) {
      CAPTURE(motion.at(1).t.x());
      CHECK(work_of(ended(box, box, motion, tolerance)) <= 100 * ordinary);
      ended(ball, box, motion, tolerance);
    }
  }
}

TEST_CASE("the search for a body that rotates 20,000 times along a small clearance gives up early") {
  // It took ten million steps.
  const FirstContactResult r = ended(closed(shapes::tetrahedron(1)), grid(6),
                                     Motion::turning(Pose::translation({1, -1, -0.25}), {0, 0, 125952},
                                                     {1, -1, -0.25}, {-30.75, -30.75, -30.75}));
  CHECK(work_of(r) < 1'000'000);
}
