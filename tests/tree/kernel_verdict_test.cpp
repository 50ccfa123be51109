// Where the kernel's float arithmetic is strained: small triangles far from the centre of their block, on
// large ones of the other body. Their planes are known badly, and the large triangles' corners are far away.
#include <cmath>

#include <doctest/doctest.h>

#include "bench/cases/families.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/coherent.hpp>
#include <lrbscope/collide.hpp>

using namespace lrb;
using cases::RandomEngine;

namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

LrbRep soup(const std::vector<Triangle>& triangles) {
  Mesh m;
  for (const Triangle& t : triangles) {
    for (const Eigen::Vector3d& x : t) {
      m.face_vertices.push_back(static_cast<VertexId>(m.vertices.size()));
      m.vertices.push_back(x);
    }
    m.face_offsets.push_back(static_cast<std::uint32_t>(m.face_vertices.size()));
  }
  return LrbRep::without_regions(m, false, false);
}

Eigen::Vector3d in_ball(RandomEngine& random) {
  const double radius = shapes::uniform(random, 0, 1);
  return radius * shapes::random_direction(random);
}

Eigen::Vector3d on(const Triangle& t, RandomEngine& random) {
  const double u = shapes::uniform(random, 0, 1), v = shapes::uniform(random, 0, 1 - u);
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

struct LargeAndSmall {
  LrbRep large, small;
  Pose pose_large, pose_small;
};

LargeAndSmall small_on_large(RandomEngine& random, double size, double offset) {
  std::vector<Triangle> large, small;
  Pose pose_large{shapes::random_rotation(random), offset * shapes::random_direction(random)};
  Pose pose_small{shapes::random_rotation(random), pose_large.t + in_ball(random)};
  for (int i = 0; i < 8; ++i) {
    Triangle t;
    for (auto& x : t) x = in_ball(random);
    large.push_back(t);
  }
  for (int i = 0; i < 24; ++i) {
    const Eigen::Vector3d centre = on(large[random() % large.size()], random);
    Triangle t;
    for (auto& x : t) {
      const Eigen::Vector3d world = pose_large.apply(centre + size * in_ball(random));
      x = pose_small.r.transpose() * (world - pose_small.t);
    }
    small.push_back(t);
  }
  return {soup(large), soup(small), pose_large, pose_small};
}

}  // namespace

TEST_CASE("small triangles on large ones: queries agree with brute force") {
  RandomEngine random(3);
  std::size_t meeting = 0;
  for (int i = 0; i < 3000; ++i) {
    const double size = std::pow(10, shapes::uniform(random, -7, -0.5));
    const double offset = i % 3 ? 0 : std::pow(10, shapes::uniform(random, -1, 6));
    const LargeAndSmall x = small_on_large(random, size, offset);
    CAPTURE(i);
    CAPTURE(size);
    CAPTURE(offset);
    const auto forth = collide(x.large, x.pose_large, x.small, x.pose_small);
    const auto back = collide(x.small, x.pose_small, x.large, x.pose_large);
    REQUIRE(forth.pairs == brute_force(x.large, x.pose_large, x.small, x.pose_small).pairs);
    REQUIRE(back.pairs == brute_force(x.small, x.pose_small, x.large, x.pose_large).pairs);
    meeting += forth.pairs.size();
  }
  CHECK(meeting > 20'000);
}

TEST_CASE("small triangles on large ones: coherent queries under tiny motions") {
  RandomEngine random(5);
  std::size_t meeting = 0, from_cache = 0, changes = 0;
  for (int i = 0; i < 300; ++i) {
    const double size = std::pow(10, shapes::uniform(random, -6, -0.5));
    LargeAndSmall x = small_on_large(random, size, i % 3 ? 0 : std::pow(10, shapes::uniform(random, -1, 5)));
    CAPTURE(i);
    CAPTURE(size);
    CoherentQuery coherent(x.large, x.small, {}, CoherentQuery::CacheUse::always);
    const Pose start = x.pose_small;
    std::size_t before = 0;
    for (int step = 0; step < 12; ++step) {
      const auto& now = coherent.collide(x.pose_large, x.pose_small);
      REQUIRE(now.pairs == brute_force(x.large, x.pose_large, x.small, x.pose_small).pairs);
      meeting += now.pairs.size();
      changes += now.pairs.size() != before;
      before = now.pairs.size();
      const double turn = shapes::uniform(random, -0.3, 0.3) * size;
      const Eigen::Vector3d axis = shapes::random_direction(random);
      x.pose_small.r = Pose::rotation(axis, turn).r * start.r;
      x.pose_small.t = start.t + 0.3 * size * in_ball(random);
    }
    from_cache += coherent.statistics().from_cache;
  }
  CHECK(meeting > 20'000);
  CHECK(from_cache > 1000);
  CHECK(changes > 500);
}

TEST_CASE("a small triangle above the long edge of an obtuse sliver: coherent queries while it descends") {
  RandomEngine random(1);
  std::size_t meeting = 0, from_cache = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Matrix3d turn = shapes::random_rotation(random);
    const double height = std::pow(10, shapes::uniform(random, -7.5, -5));
    const double gap = shapes::uniform(random, 0.2, 1) * 3e-8,
                 size = height * shapes::uniform(random, 0.1, 1);
    const Eigen::Vector3d tip(0, height + gap, 0);
    // The sliver's first corner is far from the others, and they from each other.
    const Triangle sliver = {Eigen::Vector3d(0, 0, 0), turn * Eigen::Vector3d(-1, height, 0),
                             turn * Eigen::Vector3d(1, height, 0)};
    const Triangle small = {turn * tip, turn * (tip + Eigen::Vector3d(size, 0, 0.1 * size)),
                            turn * (tip + Eigen::Vector3d(-size, 0, size))};
    const LrbRep a = soup({sliver}), b = soup({small});
    const Eigen::Vector3d down = turn * Eigen::Vector3d(0, -1, 0);
    const double step = gap / (4 + i % 4);
    CoherentQuery coherent(a, b, {}, CoherentQuery::CacheUse::always);
    CAPTURE(i);
    for (int k = -3; k < 11; ++k) {
      const Pose p = Pose::translation(k * step * down);
      const auto& now = coherent.collide(Pose{}, p);
      REQUIRE(now.pairs == brute_force(a, Pose{}, b, p).pairs);
      meeting += now.pairs.size();
    }
    from_cache += coherent.statistics().from_cache;
  }
  CHECK(meeting > 5000);
  CHECK(from_cache > 5000);
}
