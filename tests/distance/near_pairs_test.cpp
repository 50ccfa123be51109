// The pairs of triangles within a distance, against all pairs measured one after the other, in rationals
// where doubles are close to the limit.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/rational.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/world_box.hpp>

using namespace lrb;
using Eigen::Vector3d;
using shapes::RandomEngine;

namespace {

using test::closed;

struct PairsSeen {
  int queries = 0, pairs = 0, meet = 0, close_calls = 0;
};

/// Checks the answer for each pair of two bodies.
void check(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b, double within,
           PairsSeen& seen) {
  CAPTURE(within);
  NearPairsRequest request;
  request.within = within;
  const NearPairsResult result = near_pairs(a, pose_a, b, pose_b, request);
  REQUIRE(result.found == result.pairs.size());
  const std::vector<test::Points> of_a = test::real_simplices(a, pose_a),
                                  of_b = test::real_simplices(b, pose_b);
  const Eigen::AlignedBox3d box = world_box(a, pose_a).merged(world_box(b, pose_b));
  const double rough = 1e-6 * box.diagonal().norm();
  std::size_t next = 0;
  for (SimplexId s = 0; s < a.real_simplex_count(); ++s)
    for (SimplexId t = 0; t < b.real_simplex_count(); ++t) {
      const exact::Meet meet = test::meet_of(of_a[s], of_b[t]);
      const double apart = meet != exact::Meet::disjoint ? 0 : test::simplex_distance(of_a[s], of_b[t]);
      bool is_near = apart <= within;
      if (meet == exact::Meet::disjoint && std::abs(apart - within) <= rough) {
        is_near = oracle::distance_sq(of_a[s], of_b[t]) <= oracle::square(within);
        ++seen.close_calls;
      }
      const bool is_listed =
          next < result.pairs.size() && result.pairs[next].a == s && result.pairs[next].b == t;
      CAPTURE(s);
      CAPTURE(t);
      CAPTURE(apart);
      REQUIRE(is_listed == is_near);
      if (!is_listed) continue;
      const NearPair& pair = result.pairs[next++];
      REQUIRE(pair.meet == meet);
      REQUIRE((pair.upper == 0) == (meet != exact::Meet::disjoint));
      REQUIRE(pair.upper <= within);
      REQUIRE(pair.lower <= apart + rough);
      REQUIRE(pair.upper >= apart - rough);
      REQUIRE(pair.upper - pair.lower <= 1e-12 * (box.diagonal().norm() + box.min().norm()));
      REQUIRE(std::abs((pair.point[0] - pair.point[1]).norm() - pair.upper) <= rough);
      REQUIRE(test::simplex_distance({pair.point[0]}, of_a[s]) <= rough);
      REQUIRE(test::simplex_distance({pair.point[1]}, of_b[t]) <= rough);
      ++seen.pairs;
      seen.meet += meet != exact::Meet::disjoint;
    }
  REQUIRE(next == result.pairs.size());
  ++seen.queries;
}

}  // namespace

TEST_CASE("near pairs are those that brute force finds, for all kinds of bodies, poses and distances") {
  RandomEngine random(1);
  const LrbRep solids[] = {
      closed(shapes::quad_box()), closed(shapes::icosphere(0)), closed(shapes::torus(6, 5)),
      test::open_body(shapes::open_cylinder(8)),
      LrbRep::without_regions(
          shapes::several({shapes::quad_box(), shapes::translated(shapes::quad_box(), {0.5, 0.25, 0.125})}),
          true, true)};
  PairsSeen seen;
  for (const LrbRep& a : solids)
    for (const LrbRep& b : solids)
      for (int round = 0; round < 6; ++round) {
        CAPTURE(round);
        const Pose pose_a{shapes::random_rotation(random), 3 * shapes::random_direction(random)};
        Pose pose_b{shapes::random_rotation(random),
                    pose_a.t + shapes::uniform(random, 0, 3) * shapes::random_direction(random)};
        if (round == 4) pose_b.r *= 0.5;  // not a rotation
        if (round == 5) pose_b.r.col(1) += 0.75 * pose_b.r.col(0);
        const double distances[] = {0, 0.01, 0.1, shapes::uniform(random), 0.5, 4};
        check(a, pose_a, b, pose_b, distances[round], seen);
      }
  CHECK(seen.queries == 150);
  CHECK(seen.pairs > 4000);
  CHECK(seen.meet > 200);
}

TEST_CASE("near pairs are exact for flush bodies and at the distance itself") {
  const LrbRep box = closed(shapes::quad_box()), cut = closed(shapes::box());
  PairsSeen seen;
  for (const LrbRep* b : {&box, &cut})
    for (const double gap : {0.0, 0.25, 0.1}) {
      const Pose pose = Pose::translation({1 + gap, 0.5, 0});
      // The gap itself, and the doubles beside it, as B's faces are placed.
      const double at = pose.t.x() - 1;
      for (const double within : {at, std::nextafter(at, 0), std::nextafter(at, 2)})
        if (within >= 0) check(box, {}, *b, pose, within, seen);
      check(box, Pose::translation({1e9, 0, 0}), *b, Pose::translation({1e9 + 1 + gap, 0.5, 0}), gap, seen);
    }
  check(box, {}, box, {}, 0, seen);                                                // identical
  for (const double within : {2.0, 1e300}) check(box, {}, box, {}, within, seen);  // all pairs; beyond floats
  CHECK(seen.close_calls > 100);
}

TEST_CASE("near pairs of bodies in the plane, of needles, and of degenerate faces") {
  RandomEngine random(2);
  PairsSeen seen;
  test::for_flat_and_loose(random, 12, [&](const LrbRep& a, const LrbRep& b, const Pose& pose, int i) {
    const double flat[] = {0, 0.05, 0.5}, loose[] = {0, 1e-12, 0.1, 0.5};
    check(a, {}, b, pose, a.dim() == 2 ? flat[i] : loose[i / 3], seen);
  });
  CHECK(seen.pairs > 300);
}

TEST_CASE("the nearest pairs come first") {
  const LrbRep ball = closed(shapes::bumpy_sphere(4, 1));
  const Pose pose = Pose::translation({2.05, 0.1, 0.2});
  NearPairsRequest request{.within = 0.3};
  const NearPairsResult all = near_pairs(ball, {}, ball, pose, request);
  REQUIRE(all.pairs.size() > 1000);
  std::vector<double> lower;
  for (const NearPair& pair : all.pairs) lower.push_back(pair.lower);
  std::sort(lower.begin(), lower.end());
  request.nearest = 10;
  const NearPairsResult few = near_pairs(ball, {}, ball, pose, request);
  REQUIRE(few.pairs.size() == 10);
  CHECK(few.found == all.found);
  for (std::size_t i = 0; i < 10; ++i) CHECK(few.pairs[i].lower == lower[i]);
  const DistanceResult least = distance(ball, {}, ball, pose);
  CHECK(few.pairs[0].lower <= least.upper);
  CHECK(few.pairs[0].upper >= least.lower);
}

TEST_CASE("the bounds of a near pair do not depend on the other pairs") {
  const LrbRep ball = closed(shapes::bumpy_sphere(4, 1));
  const Pose pose = Pose::translation({1.98, 0.1, 0.2});
  NearPairsRequest request;
  request.within = 0.3;
  const NearPairsResult all = near_pairs(ball, {}, ball, pose, request);
  request.within = 0.05;
  const NearPairsResult some = near_pairs(ball, {}, ball, pose, request);
  REQUIRE(some.pairs.size() > 100);
  auto same = all.pairs.begin();
  for (const NearPair& pair : some.pairs) {
    while (same->a != pair.a || same->b != pair.b) ++same;
    CHECK(same->lower == pair.lower);
    CHECK(same->upper == pair.upper);
    CHECK(same->point[0] == pair.point[0]);
    CHECK(same->point[1] == pair.point[1]);
  }
}

namespace {

/// Queries of small sets of triangles on a grid, at distances that many pairs have exactly.
PairsSeen check_near_grids(int queries) {
  RandomEngine random(4);
  PairsSeen seen;
  for (int i = 0; i < queries; ++i) {
    const LrbRep a = test::open_body(test::grid_soup(random, 3)),
                 b = test::open_body(test::grid_soup(random, 3));
    const double squared = std::floor(shapes::uniform(random, 0, 9));
    check(a, {}, b, Pose::translation({std::floor(shapes::uniform(random, 0, 4)), 0, 0}), std::sqrt(squared),
          seen);
  }
  return seen;
}

}  // namespace

TEST_CASE("near pairs of triangles on a grid, at distances that they have exactly") {
  const PairsSeen seen = check_near_grids(1000);
  CHECK(seen.close_calls > 100);
  CHECK(seen.meet > 500);
}

TEST_CASE("near pairs of 100,000 sets of triangles on a grid" * doctest::test_suite("long")) {
  const PairsSeen seen = check_near_grids(100'000);
  CHECK(seen.close_calls > 10'000);
}
