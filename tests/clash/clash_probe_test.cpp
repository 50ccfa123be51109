// Reports of a clash query to a probe.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/answer_content.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/clash.hpp>

using namespace lrb;

namespace {

using test::closed;

ClashResult watched(const LrbRep& a, const LrbRep& b, const Pose& pose_b, ClashHistory& reported) {
  const ClashResult result = clash(a, {}, b, pose_b, {}, reported);
  CHECK((test::content(result) == test::content(clash(a, {}, b, pose_b))));
  return result;
}

/// Bounds of a depth tighten, except for the proof of the last upper bound, which is slightly larger than the
/// result.
void check_depth(const ClashHistory& reported, const ClashResult& result) {
  REQUIRE(result.depth.has_value());
  REQUIRE(reported.of_depth.size() >= 2);
  CHECK(reported.of_distance.empty());
  Bounds before{0, 0, std::numeric_limits<double>::infinity()};
  for (const Bounds& now : reported.of_depth) {
    CAPTURE(now.work);
    CHECK(now.work >= before.work);
    CHECK(now.lower >= before.lower);
    CHECK(now.upper <= before.upper * (1 + 1e-9));
    CHECK(now.lower <= result.depth->upper);
    CHECK(now.upper >= result.depth->lower * (1 - 1e-9));
    before = now;
  }
  CHECK(reported.of_depth.back().lower == result.depth->lower);
  CHECK(reported.of_depth.back().upper == result.depth->upper);
}

}  // namespace

TEST_CASE("clash probe: the depth of convex bodies tightens from both ends") {
  const LrbRep ball = closed(shapes::icosphere(3));
  ClashHistory reported;
  const ClashResult result = watched(ball, ball, Pose::translation({1.1, 0.3, 0.2}), reported);
  check_depth(reported, result);
  CHECK(reported.of_depth.front().lower < 0.9 * result.depth->lower);
  CHECK(std::isinf(reported.of_depth.front().upper));
  CHECK(reported.of_depth.size() > 5);
}

TEST_CASE("clash probe: the depth of a body that is not convex") {
  const LrbRep torus = closed(shapes::torus(24, 12, 1, 0.35)), ball = closed(shapes::icosphere(2));
  ClashHistory reported;
  const ClashResult result = watched(torus, ball, Pose::translation({1.2, 0.1, 0.3}), reported);
  REQUIRE(result.interiors_overlap == Answer::yes);
  check_depth(reported, result);
}

TEST_CASE("clash probe: an upper bound that no translation proves is reported as infinite at the end") {
  // So far from the origin that a pose is rounded by a quarter of the box, the search still finds a
  // translation.
  const LrbRep box = closed(shapes::box({0, 0, 0}, {1, 1, 1}));
  const Pose far = Pose::translation({1e15, 0, 0}), beside = Pose::translation({1e15 + 0.5, 0.25, 0.25});
  ClashHistory reported;
  const ClashResult result = clash(box, far, box, beside, {}, reported);
  REQUIRE(result.interiors_overlap == Answer::yes);
  REQUIRE(result.depth.has_value());
  CHECK(std::isinf(result.depth->upper));
  REQUIRE(reported.of_depth.size() >= 2);
  CHECK(std::any_of(reported.of_depth.begin(), reported.of_depth.end(),
                    [](const Bounds& b) { return std::isfinite(b.upper); }));
  CHECK(reported.of_depth.back().lower == result.depth->lower);
  CHECK(reported.of_depth.back().upper == result.depth->upper);
}

TEST_CASE("clash probe: separate bodies report their distance, touching bodies report no bounds") {
  const LrbRep box = closed(shapes::box({0, 0, 0}, {1, 1, 1}));
  ClashHistory apart, touching;
  const ClashResult gap = watched(box, box, Pose::translation({1.5, 0.25, 0.25}), apart);
  CHECK(apart.of_depth.empty());
  REQUIRE(!apart.of_distance.empty());
  CHECK(apart.of_distance.back().lower == gap.distance.lower);
  CHECK(apart.of_distance.back().upper == gap.distance.upper);
  watched(box, box, Pose::translation({1, 0.25, 0.25}), touching);
  CHECK(touching.of_depth.empty());
  CHECK(touching.of_distance.empty());
}
