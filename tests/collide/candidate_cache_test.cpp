// CacheUse of near pairs against brute force: all along a stretch, and all about a place, for motions that
// are none of rigid bodies.
#include "engine/collide/candidate_cache.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "engine/collide/tree_query.hpp"
#include "engine/tree/kernel_setup.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/collide.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

/// Triangles of about that size, with corners in and around a ball of radius 1.
LrbRep soup(RandomEngine& random, int count, double size) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const double radius = shapes::uniform(random, 0, 1);
    test::Points corners(3, radius * shapes::random_direction(random));
    for (Eigen::Vector3d& x : corners) x += size * shapes::random_direction(random);
    test::add_loose(mesh, corners);
  }
  return test::open_body(mesh);
}

Eigen::Matrix3d random_matrix(RandomEngine& random) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = shapes::uniform(random, -1, 1);
  return m;
}

constexpr double kRadius = 2.5;  ///< of a ball about the origin that holds B

double size_of(const Eigen::Matrix3d& m, const Eigen::Vector3d& t) {
  return t.norm() + m.norm() * kRadius;
}

/// Of that length, for points of B.
Sweep random_stretch(RandomEngine& random, double length, double width) {
  Sweep s;
  const Eigen::Matrix3d r = shapes::random_rotation(random);
  const double apart = shapes::uniform(random, 0, 0.5);
  const Eigen::Vector3d t = apart * shapes::random_direction(random);
  s.mid_pose = {r, t};
  s.width = width;
  if (length == 0) return s;
  const double turn = shapes::uniform(random, 0, 1);
  s.dm = turn * random_matrix(random);
  s.dt = shapes::random_direction(random);
  const double scale = length / size_of(s.dm, s.dt);
  s.dm *= scale;
  s.dt *= scale;
  s.turn = s.dm.norm();
  s.length = length;
  return s;
}

/// A pose in the stretch, off it by what `where` says.
Pose pose_in(RandomEngine& random, const Sweep& s, const SweepPoint& where) {
  Eigen::Matrix3d dm = random_matrix(random);
  if (random() % 2 == 0) dm.setZero();  // then all points are off by as much
  const Eigen::Vector3d dt = shapes::random_direction(random);
  const double scale = where.offset * (1 - 1e-9) / size_of(dm, dt);
  return {s.mid_pose.m + where.at * s.dm + scale * dm, s.mid_pose.t + where.at * s.dt + scale * dt};
}

struct CandidateTally {
  std::size_t meeting = 0, chosen = 0, listed = 0, all = 0;
};

void compare(RandomEngine& random, const LrbRep& a, const LrbRep& b, const Sweep& stretch,
             CandidateTally& tally) {
  const double rounding =
      4 * wrapper_margin(Pose{}, a.tree(), {stretch.mid_pose.m, stretch.mid_pose.t}, b.tree());
  QueryContext context;
  context.body[0].begin(a, Pose{}, CollideRequest{}.wrapper);
  context.body[1].begin(b, Pose{}, CollideRequest{}.wrapper);
  TreeKernel k = start_rigid_kernel(context, Pose{}, {stretch.mid_pose.m, stretch.mid_pose.t}, 1 << 16);
  aim_at(stretch, rounding, query_unit(a.tree(), b.tree()), k);
  run_tree_kernel(k);
  REQUIRE(is_done(k));
  CandidateCache near;
  near.clear();
  for (std::uint32_t i = 0; i < k.out_size; ++i) near.add({k.out[i].a, k.out[i].b});
  near.arrange(a, b, k, stretch, rounding, context.pair_order);
  for (int i = 0; i < 9; ++i) {
    const double share = i % 2 ? 1 : shapes::uniform(random, 0, 1);
    const SweepPoint where{stretch.length > 0 ? -1 + 0.25 * i : 0, share * stretch.width};
    const Pose pose = pose_in(random, stretch, where);
    context.body[0].world.begin(a, Pose{});
    context.body[1].world.begin(b, pose);
    tally.chosen += near.choose(where);
    near.update(set_up_kernel(a, Pose{}, b, pose),
                [&](const SimplexPair& p) { return test_simplices(context, p.a, p.b); });
    CollideResult result;
    near.append_meeting(result);
    const BruteForceResult brute = brute_force(a, Pose{}, b, pose);
    REQUIRE(result.pairs == brute.pairs);
    REQUIRE(result.meets == brute.meets);
    tally.meeting += brute.pairs.size();
    tally.listed += near.pairs().size();
    tally.all += std::size_t{a.simplex_count()} * b.simplex_count();
  }
}

/// Sweeps or fixed poses: the share of the cached pairs that is tested.
double share_tested(std::uint64_t seed, bool places) {
  RandomEngine random(seed);
  CandidateTally tally;
  for (int i = 0; i < 400; ++i) {
    CAPTURE(i);
    const double size_a = std::pow(10, shapes::uniform(random, -1.5, 0)),
                 size_b = std::pow(10, shapes::uniform(random, -1.5, 0));
    const LrbRep a = soup(random, 60, size_a), b = soup(random, 60, size_b);
    const double length = std::pow(10, shapes::uniform(random, -5, 0));
    const double width = places ? length : length * shapes::uniform(random, 0, 0.2);
    compare(random, a, b, random_stretch(random, places ? 0 : length, width), tally);
  }
  MESSAGE("of " << tally.all << " pairs " << tally.listed << " are listed, " << tally.chosen << " tested, "
                << tally.meeting << " meet");
  CHECK(tally.meeting > 10'000);
  CHECK(tally.listed < tally.all / 4);
  return static_cast<double>(tally.chosen) / static_cast<double>(tally.listed);
}

}  // namespace

TEST_CASE("a swept cache contains every pair that intersects during the sweep, and few others") {
  CHECK(share_tested(5, false) < 0.87);
}

TEST_CASE("a fixed cache contains every pair that intersects near a pose, and few others") {
  CHECK(share_tested(6, true) < 0.8);
}
