// Distances of bodies that move step by step, against those from scratch.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "engine/distance/distance_context.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

using test::closed;

struct CoherentDistanceTally {
  int meet = 0, inside = 0, apart = 0;
  std::uint64_t steps = 0, steps_alone = 0;  ///< of bodies apart
};

/// Checks an answer against that from scratch, and the pair that meets against all pairs.
void check_same(const LrbRep& a, const LrbRep& b, const PosePair& poses, const DistanceResult& coherent,
                CoherentDistanceTally& t) {
  const DistanceResult alone = distance(a, poses.a, b, poses.b);
  REQUIRE(coherent.finished);
  REQUIRE(coherent.meet == alone.meet);
  if (alone.meet) {
    ++t.meet;
    CHECK(coherent.lower == 0);
    CHECK(coherent.upper == 0);
    const BruteForceResult all = brute_force(a, poses.a, b, poses.b);
    const auto found =
        std::lower_bound(all.pairs.begin(), all.pairs.end(),
                         lrb::SimplexPair{coherent.witness[0].simplex, coherent.witness[1].simplex});
    REQUIRE(found != all.pairs.end());
    CHECK(*found == lrb::SimplexPair{coherent.witness[0].simplex, coherent.witness[1].simplex});
    const bool crosses = all.meets[static_cast<std::size_t>(found - all.pairs.begin())] == exact::Meet::cross;
    CHECK(coherent.relation == (crosses ? Relation::crossing : Relation::touching));
    return;
  }
  CHECK(coherent.relation == alone.relation);
  ++(alone.relation == Relation::separate ? t.apart : t.inside);
  t.steps += coherent.counters.steps;
  t.steps_alone += alone.counters.steps;
  CHECK(coherent.lower > 0);
  CHECK(coherent.lower <= alone.upper);
  CHECK(coherent.upper >= alone.lower);
  CHECK(coherent.upper - coherent.lower <= 1e-11);
}

}  // namespace

namespace {

/// A ball drawn out to a needle: when it turns, what is far from its middle moves far.
Mesh needle() {
  return test::stretched(shapes::icosphere(2), {2, 0.02, 0.02});
}

}  // namespace

TEST_CASE(
    "coherent distances agree with queries from scratch for walks and jumps of both bodies, in fewer steps") {
  RandomEngine random(31);
  struct {
    const char* name;
    LrbRep a, b;
    int steps = 300;
    double most = 0.1;  ///< that B turns in a step
  } const pairs[] = {
      {"bumps", closed(shapes::bumpy_sphere(2, 7, 0.3)), closed(shapes::torus(9, 7))},
      {"ball in bowl", closed(shapes::bowl(8, 4)), closed(shapes::icosphere(1, 0.3))},
      {"ball in ball", closed(shapes::icosphere(2)), closed(shapes::icosphere(1, 0.4))},
      {"ring 2D", closed(shapes::ring_2d(30)), closed(shapes::star(5, 0.3, 0.1))},
      {"rock and ring", closed(shapes::bumpy_sphere(4, 7, 0.3)), closed(shapes::torus(48, 24)), 400, 0.05},
      {"small in bowl", closed(shapes::bowl(30, 12)), closed(shapes::bumpy_sphere(3, 5, 0.3), 0.3), 400,
       0.05},
      {"outlines", closed(shapes::gear(60)), closed(shapes::star(40, 0.5, 0.2)), 400, 0.05},
      {"needle by rock", closed(shapes::bumpy_sphere(3, 7, 0.3)), closed(needle()), 400, 0.2},
      {"needle by needles", closed(shapes::several({needle(), shapes::translated(needle(), {0, 0.3, 0.1})})),
       closed(needle()), 400, 0.2}};
  CoherentDistanceTally all;
  for (const auto& pair : pairs) {
    CAPTURE(pair.name);
    const int dim = pair.a.dim();
    CoherentDistance follows(pair.a, pair.b);
    PosePair poses;
    all.steps = all.steps_alone = 0;
    for (int i = 0; i < pair.steps; ++i) {
      CAPTURE(i);
      if (i % (pair.steps > 300 ? 100 : 40) == 0)
        poses.b = shapes::random_pose(random, pair.a, pair.b, shapes::uniform(random, 0, 1.4));
      // Now hardly, now more; and now and then B turns on one spot, through more than planes outlive.
      const double share = i % 100 < 50 ? 0.001 : i % 100 < 75 ? 0.01 : pair.most;
      poses.b = i % 100 < 90
                    ? test::nudged(random, poses.b, share, share, dim)
                    : Pose{deterministic::rotation(Eigen::Vector3d::UnitZ(), 0.2) * poses.b.r, poses.b.t};
      if (i % 7 == 0) poses.a = test::nudged(random, poses.a, share, share, dim);
      check_same(pair.a, pair.b, poses, follows.distance(poses.a, poses.b), all);
    }
    // Few steps are left to save, because a query from scratch repeats none of its descent.
    if (pair.steps > 300) CHECK(20 * all.steps < 19 * all.steps_alone);
  }
  CHECK(all.meet > 50);
  CHECK(all.inside > 50);
  CHECK(all.apart > 500);
}

TEST_CASE("the bound on the approach between two poses is valid and tight") {
  RandomEngine random(32);
  const LrbRep a = closed(shapes::bumpy_sphere(1, 7, 0.3)), b = closed(shapes::torus(6, 5));
  int near_bound = 0;
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    PosePair from{{shapes::random_rotation(random), std::pow(10, i % 5) * shapes::random_direction(random)},
                  shapes::random_pose(random, a, b, 1.5)};
    from.b = {from.a.r * from.b.r, from.a.r * from.b.t + from.a.t};
    const double share = std::pow(10, -i % 7);
    PosePair to{test::nudged(random, from.a, share, share, 3), test::nudged(random, from.b, share, share, 3)};
    if (i % 2 == 0) {  // both by the same: they keep their distances
      to.a = {deterministic::rotation(Eigen::Vector3d::UnitX(), 1) * from.a.r, -from.a.t};
      to.b = {to.a.r * from.a.r.transpose() * from.b.r,
              to.a.r * (from.a.r.transpose() * (from.b.t - from.a.t)) + to.a.t};
    }
    const double by = nearer_by(a, b, from, to, 10);
    double most = 0;
    for (const Eigen::Vector3d& x : a.vertices())
      for (const Eigen::Vector3d& y : b.vertices())
        most = std::max(most,
                        (from.b.apply(y) - from.a.apply(x)).norm() - (to.b.apply(y) - to.a.apply(x)).norm());
    CHECK(most <= by);
    if (i % 2 == 0)
      CHECK(by < 1e-9);
    else
      near_bound += most > 0.25 * by;
  }
  CHECK(near_bound > 50);  // a third of those that move apart or together
  PosePair mirrored;
  mirrored.b.r(0, 0) = -1;
  CHECK(nearer_by(a, b, {}, mirrored, 1) == INFINITY);
  PosePair scaled;
  scaled.b.r *= 2;
  CHECK(nearer_by(a, b, {}, scaled, 1) == INFINITY);
  CHECK(nearer_by(a, b, {}, {Pose{}, Pose::translation({NAN, 0, 0})}, 1) == INFINITY);
}
