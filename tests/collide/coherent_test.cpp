// Coherent queries against queries from scratch: the same answers, whatever the motion.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>

using namespace lrb;
using shapes::RandomEngine;
using test::closed, test::open_body;

namespace {

struct CoherentBodies {
  const char* name;
  LrbRep a, b;
};

std::vector<CoherentBodies> coherent_bodies() {
  return {{"bumps", build_lrb(shapes::bumpy_sphere(3, 7, 0.3)), build_lrb(shapes::bumpy_sphere(2, 8, 0.3))},
          {"ball in bowl", build_lrb(shapes::bowl(24, 12)), closed(shapes::icosphere(2, 0.5))},
          {"tori", build_lrb(shapes::torus(24, 16)), closed(shapes::torus(20, 12, 1, 0.3))},
          {"combs", closed(shapes::comb(5)), closed(shapes::comb(4))},
          {"quads in a void", closed(shapes::box_with_void()), closed(shapes::quad_torus(8, 6, 0.2, 0.1))},
          {"open", open_body(shapes::open_cylinder(24)), closed(shapes::icosphere(1, 0.4))},
          {"far", closed(shapes::translated(shapes::icosphere(2), {1e7, -2e7, 3e6})),
           closed(shapes::icosphere(1, 0.6))},
          {"gears 2D", build_lrb(shapes::gear(24)), closed(shapes::gear(19, 0.9, 0.6))}};
}

/// Products of rotations drift away from rotations; this brings them back.
Pose straightened(Pose p) {
  const Eigen::Vector3d x = p.r.col(0).normalized();
  const Eigen::Vector3d z = x.cross(p.r.col(1)).normalized();
  p.r.col(0) = x;
  p.r.col(1) = z.cross(x);
  p.r.col(2) = z;
  return p;
}

struct CoherentTally {
  int contact = 0, apart = 0, inside = 0;
  std::uint64_t from_cache = 0, swept = 0, saved = 0;
};

void compare(const CollideResult& coherent, const CollideResult& scratch, Mode mode, CoherentTally& tally) {
  REQUIRE(std::string(to_string(coherent.relation)) == to_string(scratch.relation));
  REQUIRE(coherent.interiors_overlap == scratch.interiors_overlap);
  if (mode == Mode::all_pairs) {
    REQUIRE(coherent.pairs == scratch.pairs);
    REQUIRE(coherent.meets == scratch.meets);
  } else {
    REQUIRE(coherent.pairs.size() == scratch.pairs.size());
    if (!coherent.pairs.empty()) REQUIRE(coherent.meets[0] == scratch.meets[0]);
  }
  tally.contact += !scratch.pairs.empty();
  tally.apart += scratch.relation == Relation::separate;
  tally.inside += is_inside(scratch.relation);
}

/// Two poses that change from query to query.
class CoherentWalk {
 public:
  CoherentWalk(RandomEngine& random, const CoherentBodies& bodies, int kind)
      : random_(random),
        bodies_(bodies),
        kind_(kind),
        dim_(bodies.a.dim()),
        off_(shapes::box_of(bodies.a).center()) {
    jump();
    size_ = std::pow(10, shapes::uniform(random, -6, -0.3));
    for (Pose& step : steps_) step = test::nudged(random, {}, std::min(size_, 3.0), size_, dim_);
    if (kind % 4 != 1) steps_[0] = {};
  }

  const Pose& a() const { return poses_[0]; }
  const Pose& b() const { return poses_[1]; }

  void go(int i) {
    if (kind_ % 2 == 0)
      wander(i);
    else
      keep_course(i);
  }

 private:
  void jump() {
    poses_[0] = {};
    poses_[1] = shapes::random_pose(random_, bodies_.a, bodies_.b, shapes::uniform(random_, 0, 0.9));
  }
  void apply(Pose& pose, const Pose& step, const Eigen::Vector3d& about) {
    pose = {step.r * pose.r, step.r * (pose.t - about) + step.t + about};
  }
  /// Steps of all sizes, jumps, and for once a map that is no rotation.
  void wander(int i) {
    if (i % 20 == 19) size_ = i % 40 == 19 ? 0 : std::pow(10, shapes::uniform(random_, -15, 0));
    apply(poses_[1], test::nudged(random_, {}, std::min(size_, 3.0), size_, dim_), off_);
    if (kind_ % 3 == 1) {  // both move the same way
      const Pose common = test::nudged(random_, {}, 0.3, 0.3, dim_);
      for (Pose& pose : poses_) apply(pose, common, {0, 0, 0});
    }
    if (random_() % 3 == 0)
      for (Pose& pose : poses_) pose = straightened(pose);
    if (random_() % 50 == 0) jump();
    if (random_() % 60 == 0) poses_[1].r *= 1.01;
  }
  /// Screws, accelerating, curved or reversing.
  void keep_course(int i) {
    steps_[1].t *= kind_ % 3 == 2 ? 1.03 : 1;
    if (i == 30) steps_[1].t = -steps_[1].t;
    if (kind_ % 5 == 3) steps_[1] = test::nudged(random_, steps_[1], 0.02 * size_, 0.02 * size_, dim_);
    apply(poses_[1], steps_[1], off_);
    apply(poses_[0], steps_[0], {0, 0, 0});
  }

  RandomEngine& random_;
  const CoherentBodies& bodies_;
  int kind_, dim_;
  Eigen::Vector3d off_;
  double size_ = 0;
  Pose poses_[2], steps_[2];
};

/// Asks along poses, and compares with queries from scratch. Returns what the query says of its caches.
CoherentQuery::Statistics compare_along(const LrbRep& a, const LrbRep& b, const std::vector<Pose>& poses_b,
                                        CoherentTally& tally) {
  CoherentQuery coherent(a, b, {}, CoherentQuery::CacheUse::always);
  for (const Pose& p : poses_b)
    compare(coherent.collide({}, p), collide(a, {}, b, p), Mode::all_pairs, tally);
  return coherent.statistics();
}

std::vector<Pose> line(const Eigen::Vector3d& from, const Eigen::Vector3d& way, double length, double step) {
  std::vector<Pose> out;
  for (double s = 0; s < length; s += step) out.push_back(Pose::translation(from + s * way));
  return out;
}

}  // namespace

TEST_CASE(
    "coherent queries agree with queries from scratch: walks, screws, acceleration, curves, jumps and rests") {
  RandomEngine random(4711);
  CoherentTally tally;
  QueryContext context;
  NullProbe probe;
  for (const CoherentBodies& bodies : coherent_bodies())
    for (int kind = 0; kind < 32; ++kind) {
      CAPTURE(bodies.name);
      CAPTURE(kind);
      const CollideRequest request{.mode =
                                       kind % 8 == 7 || kind % 8 == 4 ? Mode::first_pair : Mode::all_pairs};
      CoherentQuery coherent(
          bodies.a, bodies.b, request,
          kind % 5 == 4 ? CoherentQuery::CacheUse::as_it_pays : CoherentQuery::CacheUse::always);
      CoherentWalk walk(random, bodies, kind);
      for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        const CollideResult scratch =
            collide(bodies.a, walk.a(), bodies.b, walk.b(), request, context, probe);
        compare(coherent.collide(walk.a(), walk.b()), scratch, request.mode, tally);
        walk.go(i);
      }
      tally.from_cache += coherent.statistics().from_cache;
      tally.swept += coherent.statistics().swept_caches;
      tally.saved += coherent.statistics().tests_saved;
    }
  MESSAGE(tally.from_cache << " answers from caches, " << tally.swept << " swept caches, " << tally.saved
                           << " tests saved; " << tally.contact << " in contact, " << tally.apart
                           << " apart, " << tally.inside << " inside");
  CHECK(tally.from_cache > 4000);
  CHECK(tally.swept > 300);
  CHECK(tally.saved > 1000);
  CHECK(tally.contact > 1000);
  CHECK(tally.apart > 600);
  CHECK(tally.inside > 100);
}

TEST_CASE(
    "coherent queries detect a small body that passes through a surface in one step, and slides of any step") {
  RandomEngine random(12);
  const LrbRep a = build_lrb(shapes::bumpy_sphere(3, 5, 0.2)), small = closed(shapes::icosphere(0, 0.01)),
               b = build_lrb(shapes::bumpy_sphere(2, 6, 0.2));
  CoherentTally through, slides;
  for (const double step : {0.03, 0.05, 0.07, 0.11, 0.13})
    CHECK(compare_along(a, small, line({1.5, 0.1, 0.02}, {-1, 0, 0}, 3, step), through).swept_caches > 1);
  CHECK(through.inside > 20);
  CHECK(through.apart > 20);
  for (const double step : {0.0002, 0.002, 0.02, 0.2}) {
    const Eigen::Vector3d way = shapes::random_direction(random);
    const auto said = compare_along(a, b, line(2.6 * way, -way, 1.2, step), slides);
    CHECK(said.from_cache > said.caches_made);
  }
  CHECK(slides.contact > 100);
}

TEST_CASE("coherent queries of bodies that leave the range of doubles") {
  using Eigen::Vector3d;
  const double size = 1e300, step = 4e307;
  const LrbRep a = closed(shapes::scaled(shapes::icosphere(2), size)),
               b = closed(shapes::scaled(shapes::bumpy_sphere(2, 6, 0.2), size));
  // Eight steps on, along a course, or off a place in any direction, end beyond the largest double.
  const std::vector<Vector3d> on_course = {{-2 * step, size, 0}, {-step, size, 0}, {0, size, 0}};
  const std::vector<Vector3d> on_none = {{step, 0, 0},    {0, step, 0}, {0, 0, step / 2},   {size, size, 0},
                                         {0, size, size}, {0, step, 0}, {size, 0, size / 2}};
  for (const auto& way : {on_course, on_none}) {
    CoherentTally tally;
    std::vector<Pose> poses;
    for (const Vector3d& t : way) poses.push_back(Pose::translation(t));
    compare_along(a, b, poses, tally);
    CHECK(tally.contact > 0);
  }
}
