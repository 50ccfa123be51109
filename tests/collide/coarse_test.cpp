// Coarse queries and certificates of separation against exact brute force and against distances measured
// here.
#include <chrono>
#include <cmath>

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/affine_maps.hpp"
#include "tests/support/coarse_checks.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/wrapper.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

struct CoarseBodies {
  const char* name;
  LrbRep a, b;
};

std::vector<CoarseBodies> coarse_bodies() {
  return {{"bumps", build_lrb(shapes::bumpy_sphere(2, 7, 0.3)), build_lrb(shapes::bumpy_sphere(2, 8, 0.3))},
          {"ball in bowl", build_lrb(shapes::bowl(16, 8)), build_lrb(shapes::icosphere(2, 0.5))},
          {"tori", build_lrb(shapes::torus(16, 10)), build_lrb(shapes::torus(14, 8, 1, 0.25))},
          {"comb, no regions", build_lrb(shapes::comb(5)),
           LrbRep::without_regions(shapes::icosphere(1, 0.5), true, false)},
          {"gears 2D", build_lrb(shapes::gear(24)), build_lrb(shapes::gear(19, 0.9, 0.6))},
          {"ring 2D", build_lrb(shapes::ring_2d(40)), build_lrb(shapes::star(7, 0.4, 0.15))}};
}

Pose pose_around(RandomEngine& random, const CoarseBodies& pair) {
  const double share = shapes::uniform(random, 0, 1.1);
  return shapes::random_pose(random, pair.a, pair.b, share);
}

CollideResult ask(const CoarseBodies& pair, const Pose& p, const CollideRequest& request,
                  QueryContext& context) {
  NullProbe probe;
  return collide(pair.a, Pose{}, pair.b, p, request, context, probe);
}

/// Checks an approximate answer against the exact one.
void check_claims(const CoarseBodies& pair, const Pose& p, const CollideResult& coarse,
                  const BruteForceResult& truth) {
  if (coarse.relation == Relation::unresolved) {
    REQUIRE(!coarse.finished);
    REQUIRE(coarse.error_bound > 0);
    if (truth.relation == Relation::separate && std::isfinite(coarse.error_bound))
      REQUIRE(test::RealSurfaces(pair.a, Pose{}, pair.b, p).between() <= coarse.error_bound);
    return;
  }
  REQUIRE(std::string(to_string(coarse.relation)) == to_string(truth.relation));
  if (coarse.error_bound != 0) {
    REQUIRE(coarse.relation == Relation::crossing);
    return;
  }
  REQUIRE(coarse.finished);
  if (coarse.mode == Mode::all_pairs) {
    REQUIRE(coarse.pairs == truth.pairs);
    REQUIRE(coarse.meets == truth.meets);
  }
}

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
  return x[x.size() / 2];
}

}  // namespace

/// Returns the error bounds of answers about two bodies, each divided by the most that one of its pairs is
/// off. Leaves out exact answers. Tolerances are shares of the larger body's size.
std::vector<double> bounds_over_truth(const CoarseBodies& pair, int poses,
                                      std::initializer_list<double> tolerances, RandomEngine& random) {
  const auto size_of = [](const LrbRep& rep) { return shapes::box_of(rep).sizes().maxCoeff(); };
  const double size = std::max(size_of(pair.a), size_of(pair.b));
  std::vector<double> ratios;
  QueryContext context;
  for (int i = 0; i < poses; ++i) {
    const Pose p = shapes::random_pose(random, pair.a, pair.b, shapes::uniform(random, 0.2, 0.6));
    const test::RealSurfaces real(pair.a, Pose{}, pair.b, p);
    for (const double tolerance : tolerances) {
      CollideRequest request;
      request.tolerance = tolerance * size;
      const CollideResult coarse = ask(pair, p, request, context);
      if (coarse.error_bound == 0) continue;
      double most = 0;
      for (const SimplexPair& q : coarse.pairs) most = std::max(most, real.off(q));
      REQUIRE(most <= coarse.error_bound * (1 + 1e-12));
      ratios.push_back(coarse.error_bound / most);
    }
  }
  return ratios;
}

TEST_CASE("the median error bound is at most three times the measured error of pairs") {
  RandomEngine random(46);
  std::vector<CoarseBodies> fine;
  fine.push_back(
      {"bumps", build_lrb(shapes::bumpy_sphere(4, 7, 0.3)), build_lrb(shapes::bumpy_sphere(4, 8, 0.3))});
  fine.push_back({"tori", build_lrb(shapes::torus(50, 40)), build_lrb(shapes::torus(44, 30, 1, 0.25))});
  fine.push_back({"gears 2D", build_lrb(shapes::gear(200)), build_lrb(shapes::gear(150, 0.9, 0.6))});
  std::vector<double> all;
  for (const CoarseBodies& pair : fine) {
    CAPTURE(pair.name);
    const std::vector<double> ratios = bounds_over_truth(pair, 12, {0.01, 0.02, 0.05, 0.1}, random);
    REQUIRE(ratios.size() > 20);
    MESSAGE(std::string(pair.name) << ": error bound over what pairs are off, median: " << median(ratios));
    all.insert(all.end(), ratios.begin(), ratios.end());
  }
  CHECK(median(all) <= 3);
}

TEST_CASE("a smaller tolerance never reports less") {
  RandomEngine random(44);
  int finer = 0;
  for (const CoarseBodies& pair : coarse_bodies()) {
    CAPTURE(pair.name);
    QueryContext context;
    for (int i = 0; i < 30; ++i) {
      CAPTURE(i);
      const Pose p = pose_around(random, pair);
      double before = INFINITY;
      for (double tolerance = 2; tolerance > 1e-6; tolerance *= 0.5) {
        CollideRequest request;
        request.tolerance = tolerance;
        const CollideResult r = ask(pair, p, request, context);
        REQUIRE(r.error_bound <= before);
        finer += r.error_bound < before && std::isfinite(before);
        before = r.error_bound;
      }
      REQUIRE(before == 0);
    }
  }
  CHECK(finer > 100);
}

TEST_CASE("an approximate query keeps its guarantees under affine maps of both bodies") {
  RandomEngine random(43);
  int with_lids = 0, separate = 0, alone = 0;
  for (const CoarseBodies& pair : coarse_bodies()) {
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
      // Far off, where rounding moves wrappers and bodies farther apart than the tolerance.
      const Eigen::Vector3d far = std::exp2(48) * Eigen::Vector3d(1.1, -1.3, dim == 2 ? 0 : 1.7);
      if (i % 4 == 2) pose_a.t += far, pose_b.t += far;
      const BruteForceResult truth = brute_force(pair.a, pose_a, pair.b, pose_b);
      for (const double tolerance : {0.02, 0.3}) {
        CollideRequest request;
        request.tolerance = tolerance;
        const CollideResult coarse = collide(pair.a, pose_a, pair.b, pose_b, request, context, probe);
        REQUIRE(coarse.relation == truth.relation);
        const bool apart = test::wrappers_are_disjoint(pair.a, pose_a, pair.b, pose_b, tolerance, context);
        if (apart) REQUIRE(truth.relation == Relation::separate);
        alone += apart;
        if (coarse.error_bound > 0) {
          ++with_lids;
          const test::RealSurfaces real(pair.a, pose_a, pair.b, pose_b);
          for (const SimplexPair& q : coarse.pairs) REQUIRE(real.off(q) <= coarse.error_bound * (1 + 1e-9));
        }
        separate += coarse.relation == Relation::separate;
      }
    }
  }
  CHECK(with_lids > 30);
  CHECK(separate > 30);
  CHECK(alone > 20);
}

/// A clock that goes on by a nanosecond each time that it is looked at.
struct CountedClock {
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<CountedClock, duration>;
  static inline std::int64_t looks = 0;
  static time_point now() { return time_point(duration(++looks)); }
};

/// Asks with a limit of that many looks at the clock.
CollideResult ask_counted(const CoarseBodies& pair, const Pose& p, double looks, QueryContext& context) {
  NullProbe probe;
  CollideRequest request;
  request.max_time = looks * 1e-9;
  CollideResult result;
  context.body[0].begin(pair.a, Pose{}, request.wrapper);
  context.body[1].begin(pair.b, p, request.wrapper);
  CountedClock::looks = 0;
  CoarseQuery<NullProbe, CountedClock>(context, request, *first_step(pair.a, pair.b, request), true, result,
                                       probe)
      .run();
  return result;
}

TEST_CASE(
    "anytime answers: within the limit, correct at every limit, exact without one, never worse with more") {
  RandomEngine random(13);
  int unfinished = 0, narrowed = 0;
  for (const CoarseBodies& pair : coarse_bodies()) {
    CAPTURE(pair.name);
    QueryContext context;
    for (int i = 0; i < 24; ++i) {
      CAPTURE(i);
      const Pose p = pose_around(random, pair);
      const BruteForceResult truth = brute_force(pair.a, Pose{}, pair.b, p);
      double before = INFINITY;
      const bool timed = i % 2 == 1;
      for (double limit = 1; limit < 1e5; limit *= timed ? 1.5 : 4) {
        CollideRequest request;
        request.max_tests = static_cast<std::uint64_t>(limit);
        const CollideResult r = timed ? ask_counted(pair, p, limit, context) : ask(pair, p, request, context);
        if (timed) {
          // Each time the kernel comes back there is a look at the clock, and one more for so many tests. The
          // look that finds the time to be up is the last; one more for rounding.
          const auto looks = static_cast<std::uint64_t>(CountedClock::looks);
          REQUIRE(r.counters.node_pairs <= between_looks::kNodePairs * looks);
          REQUIRE(r.counters.face_tests <= between_looks::kTests * looks);
          REQUIRE(static_cast<double>(looks) <= limit + 2);
        } else {
          REQUIRE(r.counters.face_tests <= request.max_tests);
        }
        REQUIRE(r.error_bound <= before);
        narrowed += r.error_bound < before && r.error_bound > 0;
        before = r.error_bound;
        unfinished += !r.finished;
        check_claims(pair, p, r, truth);
      }
      REQUIRE(before == 0);
      CollideRequest real;
      real.max_time = timed ? 100 : 1e-9;
      const CollideResult all = ask(pair, p, real, context);
      check_claims(pair, p, all, truth);
      if (!timed) continue;
      REQUIRE(all.finished);
      REQUIRE(all.pairs == truth.pairs);
    }
  }
  CHECK(unfinished > 60);
  CHECK(narrowed > 30);
}

TEST_CASE("levels of detail are built once, with deviations falling from the outermost wrapper to the body") {
  for (const CoarseBodies& pair : coarse_bodies()) {
    CAPTURE(pair.name);
    const LrbRep copy = pair.a;
    const WrapperLevels& levels = pair.a.levels();
    CHECK(&copy.levels() == &levels);
    CHECK(&pair.a.levels(2) == &levels);
    CHECK(levels.within(0) == nullptr);
    REQUIRE(!levels.all().empty());
    CHECK(levels.within(INFINITY) == &levels.all()[0]);
    double bound = INFINITY;
    std::uint32_t faces = 0;
    for (const WrapperLevel& level : levels.all()) {
      CHECK(level.bound < bound);
      CHECK(level.face_count > faces);
      CHECK(level.face_count <= pair.a.real_face_count());
      CHECK(levels.within(level.bound) == &level);
      CHECK(levels.within(std::nextafter(bound, 0)) == &level);
      bound = level.bound;
      faces = level.face_count;
      Wrapper wrapper(pair.a);
      for (RegionId r = 0; r < pair.a.region_count(); ++r)
        if (!(levels.needed()[r] <= level.bound)) wrapper.refine(r);
      CHECK(wrapper.boundary_size() == level.face_count);
      CHECK(level.tree.bounds_hold(pair.a.simplices()));
    }
  }
}
