// The distance of two bodies against rational brute force.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/affine_maps.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/rational.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/world_box.hpp>

using namespace lrb;
using oracle::Rational;
using shapes::RandomEngine;

namespace {

using test::closed;

double size_of(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  return std::max(world_box(a, pose_a).diagonal().norm(), world_box(b, pose_b).diagonal().norm());
}

struct DistanceTally {
  int poses = 0, meet = 0, inside = 0, apart = 0;
};

void check_witness(const LrbRep& rep, const Pose& pose, const Witness& w, double tolerance) {
  REQUIRE(w.face == rep.face_of_simplex(w.simplex));
  VertexId v[3];
  rep.simplex(w.simplex, v);
  test::Points feature;
  for (int k = 0; k < w.corner_count; ++k) {
    const VertexId corner = w.corners[static_cast<std::size_t>(k)];
    REQUIRE(std::find(v, v + rep.simplex_size(), corner) != v + rep.simplex_size());
    feature.push_back(pose.apply(rep.vertices()[corner]));
  }
  REQUIRE(static_cast<int>(feature.size()) == w.feature.dim + 1);
  REQUIRE(test::simplex_distance({w.point}, feature) <= tolerance);
}

void check(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b, DistanceTally& t) {
  ++t.poses;
  const DistanceResult d = distance(a, pose_a, b, pose_b);
  REQUIRE(d.finished);
  const BruteForceResult truth = brute_force(a, pose_a, b, pose_b);
  const double size = size_of(a, pose_a, b, pose_b);
  const double rounding = 1e-13 * (size + std::max(pose_a.t.norm(), pose_b.t.norm()));
  for (int side = 0; side < 2; ++side)
    check_witness(side == 0 ? a : b, side == 0 ? pose_a : pose_b, d.witness[side], rounding + 1e-9 * size);
  REQUIRE(d.meet == !truth.pairs.empty());
  if (d.meet) {
    ++t.meet;
    REQUIRE(d.lower == 0);
    REQUIRE(d.upper == 0);
    REQUIRE(std::binary_search(truth.pairs.begin(), truth.pairs.end(),
                               lrb::SimplexPair{d.witness[0].simplex, d.witness[1].simplex}));
    return;
  }
  REQUIRE(d.relation == truth.relation);
  const bool holds = is_inside(d.relation);
  t.inside += holds;
  t.apart += !holds;
  REQUIRE(d.solids_upper() == (holds ? 0 : d.upper));
  const Rational sq =
      test::surface_distance_sq(test::real_simplices(a, pose_a), test::real_simplices(b, pose_b));
  CAPTURE(d.lower);
  CAPTURE(d.upper);
  CAPTURE(std::sqrt(sq.convert_to<double>()));
  REQUIRE(oracle::square(d.lower) <= sq);
  REQUIRE(oracle::square(d.upper) >= sq);
  REQUIRE(d.lower > 0);
  const double share = d.upper > 7e10 * size ? 2.3e-13 : 0x1p-50;  // as docs/distance.md promises
  REQUIRE(d.upper - d.lower <= std::max({1e-12 * size, share * d.upper, 0x1p-1074}));
  REQUIRE(std::abs((d.witness[0].point - d.witness[1].point).norm() - d.upper) <= rounding + 1e-9 * size);
  // Whether they are within the ends of the interval, and beside them.
  for (const double most : {d.lower, d.upper, 0.5 * d.lower, 2 * d.upper}) {
    DistanceRequest request;
    request.within = most;
    const DistanceResult near = distance(a, pose_a, b, pose_b, request);
    REQUIRE(near.within.has_value());
    REQUIRE(*near.within == (sq <= oracle::square(most)));
    REQUIRE(oracle::square(near.lower) <= sq);
    if (std::isfinite(near.upper)) REQUIRE(oracle::square(near.upper) >= sq);
  }
}

/// Checks that more steps only narrow the interval.
void check_budgets(const LrbRep& a, const LrbRep& b, const Pose& pose, const DistanceResult& exact) {
  double lower = 0, upper = INFINITY;
  for (std::uint64_t steps = 1; steps < 4000; steps = steps * 3 / 2 + 1) {
    DistanceRequest request;
    request.max_steps = steps;
    const DistanceResult d = distance(a, Pose{}, b, pose, request);
    CHECK(d.counters.steps <= steps);
    CHECK(d.lower >= lower);
    CHECK(d.upper <= upper);
    CHECK(d.lower <= exact.upper);
    CHECK(d.upper >= exact.lower);
    lower = d.lower;
    upper = d.upper;
    if (d.finished) break;
  }
  CHECK(upper - lower <= 1e-11);
}

struct DistantBodies {
  const char* name;
  LrbRep a, b;
};

std::vector<DistantBodies> distant_bodies() {
  return {{"spheres", closed(shapes::icosphere(1)), closed(shapes::icosphere(1, 0.7))},
          {"bumps", closed(shapes::bumpy_sphere(1, 7, 0.3)), closed(shapes::bumpy_sphere(1, 8, 0.3))},
          {"ball in bowl", closed(shapes::bowl(8, 4)), closed(shapes::icosphere(0, 0.4))},
          {"combs", closed(shapes::comb(3)), closed(shapes::comb(2))},
          {"quads", closed(shapes::quad_box()), closed(shapes::quad_torus(6, 5))},
          {"tiny and large", closed(shapes::bumpy_sphere(1, 9)),
           closed(shapes::scaled(shapes::tetrahedron(), 1e-3))},
          {"gears 2D", closed(shapes::gear(9)), closed(shapes::gear(7, 0.9, 0.6))},
          {"ring 2D", closed(shapes::ring_2d(30)), closed(shapes::star(5, 0.3, 0.1))}};
}

}  // namespace

TEST_CASE("the interval contains the rational distance, from enclosed to distant bodies") {
  RandomEngine random(17);
  DistanceTally t;
  for (const DistantBodies& pair : distant_bodies()) {
    CAPTURE(pair.name);
    for (int i = 0; i < 6; ++i) {
      CAPTURE(i);
      const double share =
          i % 3 == 0 ? shapes::uniform(random, 0, 1) : std::pow(10, shapes::uniform(random, -1, 2));
      check(pair.a, Pose{}, pair.b, shapes::random_pose(random, pair.a, pair.b, share), t);
    }
  }
  CHECK(t.meet + t.inside > 3);
  CHECK(t.apart > 20);
}

TEST_CASE("the interval contains the rational distance of interlocked bodies") {
  RandomEngine random(23);
  DistanceTally t;
  for (const generators::Interlocked& pair : generators::interlocked(1)) {
    CAPTURE(pair.name);
    const LrbRep a = closed(pair.a), b = closed(pair.b);
    const Pose pose = test::nudged(random, pair.pose_b, 0.02, 0.03, 3);
    check(a, Pose{}, b, pose, t);
    CHECK(distance(a, Pose{}, b, pose).counters.steps > 32);  // with more than one descent
  }
  CHECK(t.apart > 2);
}

TEST_CASE("the interval contains the rational distance for bodies far from the origin") {
  RandomEngine random(18);
  DistanceTally t;
  const LrbRep a = closed(shapes::bumpy_sphere(1, 3)), b = closed(shapes::torus(7, 5));
  for (int i = 0; i < 8; ++i) {
    CAPTURE(i);
    Pose frame;
    frame.r = shapes::random_rotation(random);
    frame.t = std::pow(10, i) * shapes::random_direction(random);
    const Pose relative = shapes::random_pose(random, a, b, shapes::uniform(random, 0, 2));
    check(a, frame, b, {frame.r * relative.r, frame.r * relative.t + frame.t}, t);
  }
  CHECK(t.apart > 2);
}

TEST_CASE("the interval contains the rational distance for affine maps") {
  RandomEngine random(19);
  DistanceTally t;
  const LrbRep a = closed(shapes::icosphere(0)), b = closed(shapes::torus(6, 5));
  const LrbRep flat_a = closed(shapes::gear(7)), flat_b = closed(shapes::star(5));
  for (int kind = 0; kind < test::kMapKinds; ++kind)
    for (int i = 0; i < 4; ++i) {
      CAPTURE(kind);
      CAPTURE(i);
      const int dim = i % 4 == 3 ? 2 : 3;
      Pose pose_a, pose_b;
      pose_a.r = test::random_map(random, static_cast<test::MapKind>(i % 2 == 0 ? 0 : kind), dim);
      pose_b.r = test::random_map(random, static_cast<test::MapKind>(kind), dim);
      pose_b.t = shapes::uniform(random, 0, 4) * shapes::random_direction(random);
      if (dim == 2) pose_b.t.z() = 0;
      check(dim == 2 ? flat_a : a, pose_a, dim == 2 ? flat_b : b, pose_b, t);
    }
  // A sheet under a map that stretches only what has no extent, far from a body.
  const LrbRep sheet = test::open_body(test::sheet(3));
  for (int i = 0; i < 8; ++i) {
    Pose pose{shapes::random_rotation(random), 1e4 * shapes::random_direction(random)};
    pose.r.col(2) *= std::pow(10, i);
    check(i % 2 == 0 ? a : sheet, Pose{}, sheet, pose, t);
  }
  CHECK(t.meet > 4);
  CHECK(t.apart > 10);
}

TEST_CASE("touching bodies have distance 0, bodies with the smallest gap do not") {
  DistanceTally t;
  const LrbRep box = closed(shapes::box()), quads = closed(shapes::quad_box()),
               ball = closed(shapes::icosphere(1));
  for (const LrbRep* b : {&box, &quads})
    for (const double shift : {1.0, std::nextafter(1.0, 2), 1 + 1e-12, 1 + 1e-9, std::nextafter(1.0, 0)})
      for (const Eigen::Vector3d& way : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0),
                                         Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, 0.25, 0.5)})
        check(box, Pose{}, *b, Pose::translation(shift * way), t);
  check(ball, Pose{}, ball, Pose::translation({0, 0, 0}), t);
  CHECK(t.meet > 8);
  CHECK(t.apart > 20);
}

TEST_CASE("distances of 1e12 body sizes, and bodies of extreme sizes") {
  RandomEngine random(21);
  DistanceTally t;
  const LrbRep a = closed(shapes::icosphere(1)), b = closed(shapes::bumpy_sphere(1, 4, 0.2)),
               few = closed(shapes::tetrahedron());
  for (const double far : {1e2, 1e4, 1e6, 1e9, 1e12, 1e15, 1e20})
    for (int i = 0; i < 3; ++i) {
      CAPTURE(far);
      Pose pose;
      pose.r = shapes::random_rotation(random);
      pose.t = far * shapes::random_direction(random);
      const DistanceResult d = distance(a, Pose{}, b, pose);
      // Whatever the pair: of all corners, in rational arithmetic, none is further off than the sizes.
      const Rational centres = Rational(pose.t.x()) * Rational(pose.t.x()) +
                               Rational(pose.t.y()) * Rational(pose.t.y()) +
                               Rational(pose.t.z()) * Rational(pose.t.z());
      CHECK(oracle::square(d.lower) <= centres);
      CHECK(d.upper - d.lower <= 1e-12 * std::max(2.0, d.upper));
      if (far <= 1e2) check(a, Pose{}, b, pose, t);
      check(few, Pose{}, few, pose, t);
    }
  // No more pairs are measured than from nearby, where doubles leave as many digits.
  const LrbRep many = closed(shapes::bumpy_sphere(3, 5));
  for (const double far : {1e12, 1e15, 1e200})
    CHECK(distance(many, Pose{}, many, Pose::translation({far, 1, 2})).counters.pairs_in_doubles < 5000);
  for (const double scale : {1e-300, 1e-160, 1e150, 1e300}) {
    CAPTURE(scale);
    const LrbRep c = closed(shapes::scaled(shapes::icosphere(0), scale));
    const DistanceResult d = distance(c, Pose{}, c, Pose::translation({3 * scale, 0, 0}));
    CHECK(d.lower <= d.upper);
    CHECK(d.lower > 0.9 * scale);
    CHECK(d.upper < 1.5 * scale);
    CHECK(d.upper - d.lower <= 1e-12 * 2 * scale);
    CHECK(distance(c, Pose{}, c, Pose::translation({0.5 * scale, 0, 0})).meet);
  }
}

TEST_CASE("a tolerance and a budget only widen the interval, and more steps only narrow it") {
  RandomEngine random(22);
  const LrbRep a = closed(shapes::bumpy_sphere(3, 5)), b = closed(shapes::torus(24, 16));
  for (int i = 0; i < 12; ++i) {
    CAPTURE(i);
    Pose pose = shapes::random_pose(random, a, b, shapes::uniform(random, 0.8, 2));
    if (i % 3 == 0) pose.r *= 1.5;  // the walk in doubles
    const DistanceResult exact = distance(a, Pose{}, b, pose);
    if (exact.meet) continue;
    for (const double share : {2.0, 0.5, 0.1, 1e-3}) {
      DistanceRequest request;
      (i % 2 == 0 ? request.tolerance : request.relative_tolerance) =
          i % 2 == 0 ? share * exact.upper : share;
      const DistanceResult d = distance(a, Pose{}, b, pose, request);
      CHECK(d.finished);
      CHECK(d.lower >= 0);
      CHECK(d.counters.steps <= exact.counters.steps);
      if (share == 0.5) CHECK(2 * d.counters.steps < exact.counters.steps);
      CHECK(d.lower <= exact.upper);
      CHECK(d.upper >= exact.lower);
      CHECK(d.upper - d.lower <= share * std::max(d.upper, exact.upper) * (1 + 1e-5) + 1e-12);
    }
    check_budgets(a, b, pose, exact);
  }
  for (const generators::Interlocked& pair : generators::interlocked(1)) {
    const LrbRep outer = closed(pair.a), inner = closed(pair.b);
    check_budgets(outer, inner, pair.pose_b, distance(outer, Pose{}, inner, pair.pose_b));
  }
}
