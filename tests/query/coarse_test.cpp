// Coarse queries and certificates of separation against exact brute force and against distances measured
// here.
#include <cmath>

#include <doctest/doctest.h>

#include "engine/construct/build.hpp"
#include "engine/core/error.hpp"
#include "engine/exact/locate.hpp"
#include "engine/lrb/thickness.hpp"
#include "engine/query/brute_force.hpp"
#include "engine/query/collide_impl.hpp"
#include "scenarios/bodies/shapes/random_pose.hpp"
#include "scenarios/bodies/shapes/shapes.hpp"
#include "tests/support/affine_maps.hpp"
#include "tests/support/simplex_distance.hpp"

using namespace lrb;
using shapes::RandomEngine;

namespace {

struct Bodies {
  const char* name;
  LrbRep a, b;
};

std::vector<Bodies> bodies() {
  std::vector<Bodies> list;
  list.push_back(
      {"bumps", build_lrb(shapes::bumpy_sphere(2, 7, 0.3)), build_lrb(shapes::bumpy_sphere(2, 8, 0.3))});
  list.push_back({"ball in bowl", build_lrb(shapes::bowl(16, 8)), build_lrb(shapes::icosphere(2, 0.5))});
  list.push_back({"tori", build_lrb(shapes::torus(16, 10)), build_lrb(shapes::torus(14, 8, 1, 0.25))});
  list.push_back({"comb, no regions", build_lrb(shapes::comb(5)),
                  LrbRep::without_regions(shapes::icosphere(1, 0.5), true, false)});
  list.push_back({"gears 2D", build_lrb(shapes::gear(24)), build_lrb(shapes::gear(19, 0.9, 0.6))});
  list.push_back({"ring 2D", build_lrb(shapes::ring_2d(40)), build_lrb(shapes::star(7, 0.4, 0.15))});
  return list;
}

std::vector<std::vector<Eigen::Vector3d>> real_simplices(const LrbRep& rep, const Pose& pose) {
  std::vector<std::vector<Eigen::Vector3d>> out;
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) out.push_back(test::simplex_points(rep, pose, s));
  return out;
}

double distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  return test::surface_distance(real_simplices(a, pose_a), real_simplices(b, pose_b));
}

Pose pose_around(RandomEngine& random, const Bodies& pair) {
  const double share = shapes::uniform(random, 0, 1.1);
  return shapes::random_pose(random, pair.a, pair.b, share);
}

CollideResult ask(const Bodies& pair, const Pose& p, const CollideRequest& request, QueryContext& context) {
  NullProbe probe;
  return collide(pair.a, Pose{}, pair.b, p, request, context, probe);
}

/// What a coarse answer claims, against the truth.
void check_claims(const Bodies& pair, const Pose& p, const CollideResult& coarse,
                  const BruteForceResult& truth) {
  if (coarse.relation == Relation::separate) REQUIRE(truth.relation == Relation::separate);
  if (coarse.relation == Relation::crossing) REQUIRE(truth.relation == Relation::crossing);
  if (coarse.relation == Relation::unresolved) {
    REQUIRE(coarse.error_bound > 0);
    if (truth.relation == Relation::separate && std::isfinite(coarse.error_bound))
      REQUIRE(distance(pair.a, Pose{}, pair.b, p) <= coarse.error_bound);
  } else if (coarse.error_bound == 0) {
    REQUIRE(std::string(to_string(coarse.relation)) == to_string(truth.relation));
    REQUIRE(coarse.pairs == truth.pairs);
    REQUIRE(coarse.meets == truth.meets);
  }
}

}  // namespace

TEST_CASE("no point of a region's lids is further from the real faces than its thickness") {
  RandomEngine random(3);
  double tightest = 0;
  for (const Bodies& pair : bodies()) {
    CAPTURE(pair.name);
    const LrbRep& rep = pair.a;
    const auto real = real_simplices(rep, Pose{});
    const std::vector<double> thickness = region_thickness(rep);
    REQUIRE(thickness.size() == rep.region_count());
    for (RegionId r = 0; r < rep.region_count(); ++r) {
      REQUIRE(std::isfinite(thickness[r]) == !rep.lids(r).empty());
      if (rep.lids(r).empty()) continue;
      std::vector<std::vector<Eigen::Vector3d>> sides;
      for (const FaceId f : rep.lids(r))
        for (SimplexId i = 0; i < Mesh::simplices_of(rep.face(f).size(), rep.dim()); ++i)
          sides.push_back(test::simplex_points(rep, Pose{}, rep.first_simplex(f) + i));
      for (int sample = 0; sample < 12; ++sample) {
        const Eigen::Vector3d x = test::random_point_of(random, sides[random() % sides.size()]);
        double least = INFINITY;
        for (const auto& s : real) least = std::min(least, test::simplex_distance({x}, s));
        REQUIRE(least <= thickness[r]);
        tightest = std::max(tightest, least / thickness[r]);
      }
    }
  }
  CHECK(tightest > 0.5);
}

TEST_CASE("a query with a tolerance never calls bodies separate that meet, and keeps its error bound") {
  RandomEngine random(41);
  int unresolved = 0, separate_with_lids = 0, with_pseudo = 0, crossing = 0;
  for (const Bodies& pair : bodies()) {
    CAPTURE(pair.name);
    QueryContext context;
    for (int i = 0; i < 30; ++i) {
      CAPTURE(i);
      const Pose p = pose_around(random, pair);
      const BruteForceResult truth = brute_force(pair.a, Pose{}, pair.b, p);
      for (const double tolerance : {0.01, 0.1, 0.5}) {
        CAPTURE(tolerance);
        CollideRequest request;
        request.tolerance = tolerance;
        const CollideResult coarse = ask(pair, p, request, context);
        REQUIRE(coarse.finished);
        REQUIRE(coarse.error_bound <= 2 * tolerance * (1 + 1e-4));
        check_claims(pair, p, coarse, truth);
        request.mode = Mode::first_pair;
        const CollideResult first = ask(pair, p, request, context);
        REQUIRE(first.pairs.size() <= 1);
        REQUIRE((first.relation == Relation::separate) == (coarse.relation == Relation::separate));
        if (!first.pairs.empty())
          REQUIRE(std::binary_search(coarse.pairs.begin(), coarse.pairs.end(), first.pairs[0]));
        unresolved += coarse.relation == Relation::unresolved;
        crossing += coarse.relation == Relation::crossing;
        separate_with_lids += coarse.relation == Relation::separate && tolerance >= 0.1;
        for (const SimplexPair& q : coarse.pairs)
          with_pseudo += !pair.a.is_real_simplex(q.a) || !pair.b.is_real_simplex(q.b);
      }
    }
  }
  CHECK(unresolved > 30);
  CHECK(crossing > 25);
  CHECK(separate_with_lids > 25);
  CHECK(with_pseudo > 300);
}

TEST_CASE("a query with a tolerance keeps its claims under affine maps of both bodies") {
  RandomEngine random(43);
  int unresolved = 0, separate = 0;
  for (const Bodies& pair : bodies()) {
    CAPTURE(pair.name);
    QueryContext context;
    NullProbe probe;
    for (int i = 0; i < 30; ++i) {
      CAPTURE(i);
      const int dim = pair.a.dim();
      const Pose p = pose_around(random, pair);
      const Eigen::Matrix3d map =
          test::random_map(random, static_cast<test::MapKind>(i % test::kMapKinds), dim);
      Pose pose_a{i % 3 ? map : Eigen::Matrix3d::Identity(), {0, 0, 0}},
          pose_b{pose_a.r * p.r, pose_a.r * p.t};
      if (i % 3 != 1) pose_b.r = test::random_map(random, test::MapKind::sheared, dim) * pose_b.r;
      const BruteForceResult truth = brute_force(pair.a, pose_a, pair.b, pose_b);
      for (const double tolerance : {0.02, 0.3}) {
        CollideRequest request;
        request.tolerance = tolerance;
        const CollideResult coarse = collide(pair.a, pose_a, pair.b, pose_b, request, context, probe);
        if (coarse.relation == Relation::separate) REQUIRE(truth.relation == Relation::separate);
        if (coarse.relation == Relation::crossing) REQUIRE(truth.relation == Relation::crossing);
        if (coarse.relation == Relation::unresolved && truth.relation == Relation::separate)
          REQUIRE(distance(pair.a, pose_a, pair.b, pose_b) <= coarse.error_bound);
        unresolved += coarse.relation == Relation::unresolved;
        separate += coarse.relation == Relation::separate;
      }
    }
  }
  CHECK(unresolved > 30);
  CHECK(separate > 30);
}

TEST_CASE("bodies that touch under flat lids are never called separate") {
  // Boxes against boxes and combs: lids lie in the planes of faces, and rounding moves both.
  RandomEngine random(77);
  const Bodies pair{"combs", build_lrb(shapes::comb(4)), build_lrb(shapes::comb(3))};
  QueryContext context;
  int meeting = 0;
  for (int i = 0; i < 150; ++i) {
    const Pose frame{shapes::random_rotation(random), 10 * shapes::random_direction(random)};
    Pose p;
    for (int k = 0; k < 3; ++k) p.t[k] = static_cast<double>(random() % 13) / 2 - 3;
    const Pose pose_b{frame.r, frame.r * p.t + frame.t};
    const BruteForceResult truth = brute_force(pair.a, frame, pair.b, pose_b);
    meeting += truth.relation != Relation::separate;
    CollideRequest request;
    request.tolerance = 10;
    NullProbe probe;
    const CollideResult coarse = collide(pair.a, frame, pair.b, pose_b, request, context, probe);
    if (coarse.relation == Relation::separate) REQUIRE(truth.relation == Relation::separate);
  }
  CHECK(meeting > 50);
}

TEST_CASE("an answer at any time: within the limit, true as far as it goes, and exact in the end") {
  RandomEngine random(13);
  int unfinished = 0, narrowed = 0;
  for (const Bodies& pair : bodies()) {
    CAPTURE(pair.name);
    QueryContext context;
    for (int i = 0; i < 12; ++i) {
      const Pose p = pose_around(random, pair);
      const BruteForceResult truth = brute_force(pair.a, Pose{}, pair.b, p);
      double before = INFINITY;
      for (std::uint64_t limit = 1; limit < 100'000; limit *= 4) {
        CollideRequest request;
        request.max_tests = limit;
        const CollideResult r = ask(pair, p, request, context);
        REQUIRE(r.counters.face_tests <= limit);
        REQUIRE(r.error_bound <= before);
        narrowed += r.error_bound < before && r.error_bound > 0;
        before = r.error_bound;
        unfinished += !r.finished;
        check_claims(pair, p, r, truth);
      }
      REQUIRE(before == 0);
      CollideRequest timed;
      timed.max_time = 1e-9;
      check_claims(pair, p, ask(pair, p, timed, context), truth);
      timed.max_time = 100;
      const CollideResult all = ask(pair, p, timed, context);
      REQUIRE(all.finished);
      REQUIRE(all.pairs == truth.pairs);
    }
  }
  CHECK(unfinished > 30);
  CHECK(narrowed > 15);
}

TEST_CASE("open bodies are queried as they are") {
  const LrbRep open = LrbRep::without_regions(shapes::open_cylinder(12), false, false);
  const LrbRep ball = build_lrb(shapes::icosphere(2, 0.1));
  CollideRequest request;
  request.tolerance = 1;
  request.separation = true;
  const CollideResult r = collide(open, Pose{}, ball, Pose::translation({50, 0, 0}), request);
  CHECK(r.relation == Relation::undefined);
  CHECK(r.error_bound == 0);
  CHECK(!r.separation);
}

TEST_CASE("what a coarse query cannot give is refused") {
  const LrbRep a = build_lrb(shapes::box());
  CollideRequest request;
  request.tolerance = -1;
  CHECK(collide(a, Pose{}, a, Pose{}, request).error_bound == 0);  // not asked for
  request.tolerance = INFINITY;
  CHECK_THROWS_AS(collide(a, Pose{}, a, Pose{}, request), InputError);
  request.tolerance = 1;
  request.contacts = true;
  CHECK_THROWS_AS(collide(a, Pose{}, a, Pose{}, request), InputError);
  request.contacts = false;
  request.recursion = Recursion::paper;
  CHECK_THROWS_AS(collide(a, Pose{}, a, Pose{}, request), InputError);
}
