// The predicted motion of B, point by point.
#include "engine/collide/relative_motion.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"

using namespace lrb;
using shapes::RandomEngine;

namespace {

/// One after the other: `then` after `first`.
Pose after(const Pose& first, const Pose& then) {
  return {then.r * first.r, then.r * first.t + then.t};
}

Eigen::Vector3d on_a(const Pose& a, const Pose& b, const Eigen::Vector3d& x) {
  return a.r.transpose() * (b.apply(x) - a.t);
}

struct Walk {
  Pose a, b, step_a, step_b;

  /// Not rotations to the last bit, as those of a simulation.
  explicit Walk(RandomEngine& random, double size, double drift = 0) {
    b.t = 3 * shapes::random_direction(random);
    for (Pose* step : {&step_a, &step_b}) {
      const double angle = shapes::uniform(random, 0, size);
      const Eigen::Vector3d axis = shapes::random_direction(random);
      *step = Pose::rotation(axis, angle);
      step->r *= 1 + drift;
      step->t = size * shapes::random_direction(random);
    }
  }
  void go() {
    a = after(a, step_a);
    b = after(b, step_b);
  }
};

}  // namespace

TEST_CASE("no point of B moves further than the predicted motion allows") {
  RandomEngine random(1);
  Mesh rod = shapes::icosphere(2);
  for (Eigen::Vector3d& x : rod.vertices) x.x() *= 20;
  const LrbRep body = LrbRep::without_regions(rod, true, false);
  double largest = 0, largest_turn = 0;
  for (int i = 0; i < 500; ++i) {
    const double size = std::pow(10, shapes::uniform(random, -9, 0));
    const double drift = i % 2 ? 1e-9 * shapes::uniform(random, -1, 1) : 0;
    Walk walk(random, size, drift);
    if (i % 5 == 0) {  // turns about B's middle alone
      walk.step_a = {};
      walk.step_b.t = walk.b.t - walk.step_b.r * walk.b.t;
    }
    RelativeMotion history(body, body);
    REQUIRE(history.record(walk.a, walk.b));
    CHECK(std::isinf(history.step()));
    for (int step = 0; step < 3; ++step) {
      const Walk before = walk;
      walk.go();
      if (!history.record(walk.a, walk.b)) {
        CHECK(drift != 0);
        break;
      }
      for (const Eigen::Vector3d& x : body.vertices()) {
        const double moved = (on_a(walk.a, walk.b, x) - on_a(before.a, before.b, x)).norm();
        REQUIRE(moved <= history.step());
        double& share = i % 5 == 0 ? largest_turn : largest;
        if (size > 1e-6) share = std::max(share, moved / history.step());
      }
    }
  }
  MESSAGE("largest motion: " << largest << " of the bound, by rotation " << largest_turn);
  CHECK(largest > 0.9);
  CHECK(largest_turn > 0.9);
}
