// Reports of a distance query to a probe: bounds that are valid, tighten, and end at the answer, which is the
// same as without.
#include <limits>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/answer_content.hpp"
#include <lrbscope/distance.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Checks that bounds tighten, that work grows, and that all hold a distance that is known from an interval.
void check_history(const std::vector<Bounds>& history, const DistanceResult& exact) {
  REQUIRE(!history.empty());
  Bounds before{0, 0, kInfinity};
  for (const Bounds& now : history) {
    CAPTURE(now.work);
    CHECK(now.work >= before.work);
    CHECK(now.lower >= before.lower);
    CHECK(now.upper <= before.upper);
    CHECK((now.lower > before.lower || now.upper < before.upper));
    CHECK(now.lower <= exact.upper);
    CHECK(now.upper >= exact.lower);
    before = now;
  }
}

void check_watched(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                   const DistanceRequest& request = {}) {
  BoundsHistory reported;
  const DistanceResult watched = distance(a, pose_a, b, pose_b, request, reported);
  const DistanceResult plain = distance(a, pose_a, b, pose_b, request);
  CHECK((test::content(watched) == test::content(plain)));
  check_history(reported.history, distance(a, pose_a, b, pose_b));
  CHECK(reported.history.back().lower >= watched.lower);
  CHECK(reported.history.back().upper <= watched.upper);
  if (request.within) return;
  if (request.relative_tolerance > 0) {  // reported bounds may be narrower than requested
    CHECK(watched.upper - watched.lower <= request.relative_tolerance * watched.upper);
    return;
  }
  CHECK(reported.history.back().lower == watched.lower);
  CHECK(reported.history.back().upper == watched.upper);
}

}  // namespace

TEST_CASE("distance probe: bounds are valid and tighten, and the answer is the same as without a probe") {
  const LrbRep ball = LrbRep::without_regions(shapes::icosphere(4), true, false);
  const LrbRep small = LrbRep::without_regions(shapes::icosphere(2), true, false);
  RandomEngine random(7);
  for (int i = 0; i < 12; ++i) {
    CAPTURE(i);
    Pose pose_a, pose_b;
    pose_a.r = shapes::random_rotation(random);
    pose_b.r = shapes::random_rotation(random);
    pose_b.t = pose_b.r * Eigen::Vector3d(0.4 * i, 0.1, 0.05);  // from meeting to far apart
    check_watched(ball, pose_a, small, pose_b);
    DistanceRequest within;
    within.within = 0.3;
    check_watched(ball, pose_a, small, pose_b, within);
    DistanceRequest few;
    few.max_steps = static_cast<std::uint64_t>(i) + 1;
    check_watched(ball, pose_a, small, pose_b, few);
    DistanceRequest rough;
    rough.relative_tolerance = 0.1;
    check_watched(ball, pose_a, small, pose_b, rough);
  }
}

TEST_CASE("distance probe: traversals in doubles are reported") {
  const LrbRep ball = LrbRep::without_regions(shapes::icosphere(3), true, false);
  Pose squeezed;
  squeezed.r = Eigen::Vector3d(1, 0.5, 0.25).asDiagonal();
  squeezed.t = {3, 1, 0.5};
  BoundsHistory reported;
  const DistanceResult result = distance(ball, {}, ball, squeezed, {}, reported);
  CHECK((test::content(result) == test::content(distance(ball, {}, ball, squeezed))));
  check_history(reported.history, result);
  CHECK(reported.history.size() > 5);
  CHECK(reported.history.front().lower < 0.99 * result.lower);
}

TEST_CASE("distance probe: the history of the interval starts step by step") {
  const LrbRep ball = LrbRep::without_regions(shapes::icosphere(4), true, false);
  BoundsHistory reported;
  const DistanceResult result = distance(ball, {}, ball, Pose::translation({2.3, 0.4, 0.2}), {}, reported);
  check_history(reported.history, result);
  REQUIRE(reported.history.size() > 5);
  CHECK(reported.history.front().lower < 0.9 * result.lower);
  CHECK(reported.history.front().work < 64);
  CHECK(reported.history.back().work ==
        result.counters.steps + result.counters.pairs_in_doubles + result.counters.pairs_exact);
}
