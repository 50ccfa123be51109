// Coherent queries against queries from scratch: the same answers, whatever the motion.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

struct CoherentBodies {
  const char* name;
  LrbRep a, b;
};

LrbRep bare(const Mesh& mesh, bool closed = true) {
  return LrbRep::without_regions(mesh, closed, false);
}

std::vector<CoherentBodies> coherent_bodies() {
  std::vector<CoherentBodies> list;
  list.push_back(
      {"bumps", build_lrb(shapes::bumpy_sphere(3, 7, 0.3)), build_lrb(shapes::bumpy_sphere(2, 8, 0.3))});
  list.push_back({"ball in bowl", build_lrb(shapes::bowl(24, 12)), bare(shapes::icosphere(2, 0.5))});
  list.push_back({"tori", build_lrb(shapes::torus(24, 16)), bare(shapes::torus(20, 12, 1, 0.3))});
  list.push_back({"combs", bare(shapes::comb(5)), bare(shapes::comb(4))});
  list.push_back(
      {"quads in a void", bare(shapes::box_with_void()), bare(shapes::quad_torus(8, 6, 0.2, 0.1))});
  list.push_back({"open", bare(shapes::open_cylinder(24), false), bare(shapes::icosphere(1, 0.4))});
  list.push_back({"far", bare(shapes::translated(shapes::icosphere(2), {1e7, -2e7, 3e6})),
                  bare(shapes::icosphere(1, 0.6))});
  list.push_back({"gears 2D", build_lrb(shapes::gear(24)), bare(shapes::gear(19, 0.9, 0.6))});
  return list;
}

/// A motion of about `size` (of points within 1 of the origin).
Pose moved(RandomEngine& random, const Pose& p, double size, int dim) {
  const double angle = shapes::uniform(random, -1, 1) * std::min(size, 3.0);
  const Eigen::Vector3d axis = dim == 2 ? Eigen::Vector3d::UnitZ() : shapes::random_direction(random);
  Eigen::Vector3d shift = size * shapes::random_direction(random);
  if (dim == 2) shift.z() = 0;
  const Pose turn = Pose::rotation(axis, angle);
  return {turn.r * p.r, p.t + shift};
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
  int queries = 0, contact = 0, apart = 0, inside = 0, changes = 0;
};

void compare(const CollideResult& coherent, const CollideResult& scratch, Mode mode, CoherentTally& tally) {
  REQUIRE(std::string(to_string(coherent.relation)) == to_string(scratch.relation));
  REQUIRE(coherent.interiors_overlap == scratch.interiors_overlap);
  if (mode == Mode::all_pairs) {
    REQUIRE(coherent.pairs == scratch.pairs);
    REQUIRE(coherent.meets == scratch.meets);
  } else {
    REQUIRE(coherent.pairs.empty() == scratch.pairs.empty());
    REQUIRE(coherent.pairs.size() <= 1);
    if (!coherent.pairs.empty()) REQUIRE(coherent.meets[0] == scratch.meets[0]);
  }
  ++tally.queries;
  tally.contact += !scratch.pairs.empty();
  tally.apart += scratch.relation == Relation::separate;
  tally.inside += scratch.relation == Relation::a_inside_b || scratch.relation == Relation::b_inside_a;
}

void add(CoherentQuery::Statistics& sum, const CoherentQuery::Statistics& s) {
  sum.from_cache += s.from_cache;
  sum.caches_made += s.caches_made;
  sum.swept_caches += s.swept_caches;
  sum.from_scratch += s.from_scratch;
  sum.tests_saved += s.tests_saved;
}

}  // namespace

TEST_CASE("coherent queries agree with queries from scratch for motions of all sizes") {
  RandomEngine random(4711);
  CoherentTally tally;
  CoherentQuery::Statistics sum;
  for (const CoherentBodies& pair : coherent_bodies()) {
    CAPTURE(pair.name);
    const Eigen::Vector3d off = shapes::box_of(pair.a).center();
    for (int walk = 0; walk < 14; ++walk) {
      CAPTURE(walk);
      CollideRequest request;
      request.mode = walk % 4 == 3 ? Mode::first_pair : Mode::all_pairs;
      CoherentQuery coherent(
          pair.a, pair.b, request,
          walk % 5 == 4 ? CoherentQuery::CacheUse::as_it_pays : CoherentQuery::CacheUse::always);
      QueryContext context;
      const double share = shapes::uniform(random, 0, 0.9);
      Pose pose_a, pose_b = shapes::random_pose(random, pair.a, pair.b, share);
      double size = std::pow(10, shapes::uniform(random, -6, -0.5));
      Relation before = Relation::separate;
      for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        NullProbe probe;
        const CollideResult scratch = collide(pair.a, pose_a, pair.b, pose_b, request, context, probe);
        compare(coherent.collide(pose_a, pose_b), scratch, request.mode, tally);
        tally.changes += scratch.relation != before;
        before = scratch.relation;
        if (i % 20 == 19) size = std::pow(10, shapes::uniform(random, -6, 0));
        Pose about = pose_b;
        about.t -= off;
        about = straightened(moved(random, about, size, pair.a.dim()));
        about.t += off;
        pose_b = about;
        // Both move: the same way for a while, then each on its own; and now and then a jump.
        if (walk % 3 == 1) {
          const Pose common = moved(random, Pose{}, 0.3, pair.a.dim());
          pose_a = straightened({common.r * pose_a.r, common.r * pose_a.t + common.t});
          pose_b = straightened({common.r * pose_b.r, common.r * pose_b.t + common.t});
        }
        if (random() % 50 == 0) {
          pose_a = {};
          const double again = shapes::uniform(random, 0, 0.9);
          pose_b = shapes::random_pose(random, pair.a, pair.b, again);
        }
        if (random() % 60 == 0) pose_b.r *= 1.01;  // no rotation for once
        if (random() % 3 == 0) pose_b = straightened(pose_b);
      }
      add(sum, coherent.statistics());
    }
  }
  MESSAGE(tally.queries << " queries: " << sum.from_cache << " from lists, " << sum.caches_made
                        << " lists made, " << sum.from_scratch << " from scratch, " << sum.tests_saved
                        << " tests saved; " << tally.contact << " in contact, " << tally.apart << " apart, "
                        << tally.inside << " inside, " << tally.changes << " changes of relation");
  CHECK(sum.from_cache > 1000);
  CHECK(sum.caches_made > 200);
  CHECK(sum.tests_saved > 1000);
  CHECK(tally.contact > 500);
  CHECK(tally.apart > 300);
  CHECK(tally.inside > 50);
  CHECK(tally.changes > 200);
}

TEST_CASE("coherent queries along paths: screws, acceleration, curves and reversals") {
  RandomEngine random(815);
  CoherentTally tally;
  CoherentQuery::Statistics sum;
  for (const CoherentBodies& pair : coherent_bodies()) {
    CAPTURE(pair.name);
    const int dim = pair.a.dim();
    const Eigen::Vector3d off = shapes::box_of(pair.a).center();
    for (int walk = 0; walk < 24; ++walk) {
      CAPTURE(walk);
      CollideRequest request;
      request.mode = walk % 8 == 7 ? Mode::first_pair : Mode::all_pairs;
      CoherentQuery coherent(
          pair.a, pair.b, request,
          walk % 6 == 5 ? CoherentQuery::CacheUse::as_it_pays : CoherentQuery::CacheUse::always);
      QueryContext context;
      NullProbe probe;
      const double share = shapes::uniform(random, 0, 0.9);
      Pose pose_a, pose_b = shapes::random_pose(random, pair.a, pair.b, share);
      const double size = std::pow(10, shapes::uniform(random, -5, -0.3));
      Pose step_a = walk % 4 == 1 ? moved(random, Pose{}, size, dim) : Pose{};
      Pose step_b = moved(random, Pose{}, size, dim);
      const double faster = walk % 3 == 2 ? 1.03 : 1;
      for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        const CollideResult scratch = collide(pair.a, pose_a, pair.b, pose_b, request, context, probe);
        compare(coherent.collide(pose_a, pose_b), scratch, request.mode, tally);
        step_b.t *= faster;
        if (i == 30) step_b.t = -step_b.t;
        if (walk % 5 == 3) step_b = moved(random, step_b, 0.02 * size, dim);
        Pose about = pose_b;
        about.t -= off;
        pose_b = {step_b.r * about.r, step_b.r * about.t + step_b.t + off};
        pose_a = {step_a.r * pose_a.r, step_a.r * pose_a.t + step_a.t};
      }
      add(sum, coherent.statistics());
    }
  }
  MESSAGE(tally.queries << " queries: " << sum.from_cache << " from lists, " << sum.caches_made
                        << " lists made, " << sum.swept_caches << " of them ahead; " << tally.contact
                        << " in contact, " << tally.apart << " apart, " << tally.inside << " inside");
  CHECK(sum.from_cache > 3000);
  CHECK(sum.swept_caches > 300);
  CHECK(tally.contact > 500);
  CHECK(tally.apart > 300);
  CHECK(tally.inside > 50);
}

TEST_CASE("coherent queries detect a small body that passes through a surface in one step") {
  const LrbRep a = build_lrb(shapes::bumpy_sphere(3, 5, 0.2)), b = bare(shapes::icosphere(0, 0.01));
  QueryContext context;
  NullProbe probe;
  CoherentTally tally;
  Relation before = Relation::separate;
  int through = 0;
  for (const double step : {0.03, 0.05, 0.07, 0.11, 0.13}) {
    CoherentQuery coherent(a, b, {}, CoherentQuery::CacheUse::always);
    for (double s = 1.5; s > -1.5; s -= step) {
      const Pose p = Pose::translation({s, 0.1, 0.02});
      const CollideResult scratch = collide(a, Pose{}, b, p, {}, context, probe);
      compare(coherent.collide(Pose{}, p), scratch, Mode::all_pairs, tally);
      through += scratch.relation != before && scratch.relation != Relation::crossing &&
                 before != Relation::crossing;
      before = scratch.relation;
    }
    CHECK(coherent.statistics().swept_caches > 1);
  }
  CHECK(through > 3);
}

TEST_CASE("coherent queries detect a body that slides through a contact in steps of every size") {
  RandomEngine random(12);
  const LrbRep a = build_lrb(shapes::bumpy_sphere(3, 5, 0.2)), b = build_lrb(shapes::bumpy_sphere(2, 6, 0.2));
  QueryContext context;
  NullProbe probe;
  CoherentTally tally;
  for (const double step : {0.0002, 0.002, 0.02, 0.2}) {
    CoherentQuery coherent(a, b, {}, CoherentQuery::CacheUse::always);
    const Eigen::Vector3d way = shapes::random_direction(random);
    for (double s = 2.6; s > 1.4; s -= step) {
      const Pose p = Pose::translation(s * way);
      compare(coherent.collide(Pose{}, p), collide(a, Pose{}, b, p, {}, context, probe), Mode::all_pairs,
              tally);
    }
    CHECK(coherent.statistics().from_cache > coherent.statistics().caches_made);
  }
  CHECK(tally.contact > 100);
}

TEST_CASE("coherent queries of bodies of any size") {
  QueryContext context;
  NullProbe probe;
  for (const double size : {1e-310, 1e-300, 1e-200, 1e-160, 1e-12, 1e9, 1e150, 1e200, 1e300}) {
    CAPTURE(size);
    const LrbRep a = bare(shapes::scaled(shapes::icosphere(2), size)),
                 b = bare(shapes::scaled(shapes::bumpy_sphere(2, 6, 0.2), size));
    CoherentQuery coherent(a, b, {}, CoherentQuery::CacheUse::always);
    CoherentTally tally;
    for (double s = 2.3; s > 1.7; s -= 0.01) {
      const Pose p = Pose::translation(size * Eigen::Vector3d(s, 0.1, 0));
      compare(coherent.collide(Pose{}, p), collide(a, Pose{}, b, p, {}, context, probe), Mode::all_pairs,
              tally);
    }
    CHECK(coherent.statistics().from_cache > 10);
    CHECK(tally.contact > 10);
  }
}

TEST_CASE("coherent queries of resting, slow and restarting bodies") {
  const LrbRep a = build_lrb(shapes::bumpy_sphere(3, 5, 0.2)), b = build_lrb(shapes::bumpy_sphere(2, 6, 0.2));
  QueryContext context;
  NullProbe probe;
  CoherentTally tally;
  CoherentQuery coherent(a, b, {}, CoherentQuery::CacheUse::always);
  Pose p = Pose::translation({2.2, 0.1, 0});
  for (const double step : {0.0, 0.01, 0.0, 1e-15, 0.003, 0.0, 1e-12, 0.001, 0.0})
    for (int i = 0; i < 30; ++i) {
      p.t.x() -= step;
      compare(coherent.collide(Pose{}, p), collide(a, Pose{}, b, p, {}, context, probe), Mode::all_pairs,
              tally);
    }
  CHECK(coherent.statistics().from_cache > 100);
  CHECK(tally.contact > 50);
  CHECK(tally.apart > 30);
}

TEST_CASE("coherent queries of bodies that leave the range of doubles") {
  using Eigen::Vector3d;
  const double size = 1e300, step = 4e307;
  const LrbRep a = bare(shapes::scaled(shapes::icosphere(2), size)),
               b = bare(shapes::scaled(shapes::bumpy_sphere(2, 6, 0.2), size));
  // Eight steps on, along a course, or off a place in any direction, end beyond the largest double.
  const std::vector<Vector3d> on_course = {{-2 * step, size, 0}, {-step, size, 0}, {0, size, 0}};
  const std::vector<Vector3d> on_none = {{step, 0, 0},    {0, step, 0}, {0, 0, step / 2},   {size, size, 0},
                                         {0, size, size}, {0, step, 0}, {size, 0, size / 2}};
  QueryContext context;
  NullProbe probe;
  for (const auto& way : {on_course, on_none}) {
    CoherentQuery coherent(a, b, {}, CoherentQuery::CacheUse::always);
    CoherentTally tally;
    for (const Vector3d& t : way) {
      const Pose p = Pose::translation(t);
      compare(coherent.collide(Pose{}, p), collide(a, Pose{}, b, p, {}, context, probe), Mode::all_pairs,
              tally);
    }
    CHECK(tally.contact > 0);
  }
}

TEST_CASE("a coherent query without a cache runs from scratch") {
  const LrbRep a = build_lrb(shapes::bumpy_sphere(2, 5, 0.2));
  CollideRequest request;
  request.contacts = true;
  CoherentQuery with_contacts(a, a, request);
  request.recursion = Recursion::paper;
  CoherentQuery paper(a, a, request);
  for (int i = 0; i < 6; ++i) {
    const Pose p = Pose::translation({1.2 + 1e-4 * i, 0.3, 0});
    CHECK(with_contacts.collide(Pose{}, p).contacts.size() == with_contacts.collide(Pose{}, p).pairs.size());
    request.recursion = Recursion::paper;
    CHECK(paper.collide(Pose{}, p).pairs == collide(a, Pose{}, a, p, request).pairs);
    request.recursion = Recursion::complete;
    const CollideResult& r = with_contacts.collide(Pose{}, p);
    CHECK(r.regions.size() == collide(a, Pose{}, a, p, request).regions.size());
  }
  CHECK(paper.statistics().from_cache == 0);
}
