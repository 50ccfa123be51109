#pragma once
/// Poses of one body near another, and how long a query of them takes.

#include <algorithm>
#include <chrono>
#include <vector>

#include "bench/speed/make_sets.hpp"
#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"

namespace lrb::bench {

/// A pose of B at first contact, reached along a random direction, with a random rotation.
struct Approach {
  Pose contact;
  Eigen::Vector3d direction;

  /// Returns the pose this much deeper; negative: apart.
  Pose beyond(double depth) const { return {contact.r, contact.t - depth * direction}; }
};

inline std::vector<Approach> approaches(const LrbRep& a, const LrbRep& b, double diagonal, int count) {
  shapes::RandomEngine random(1);
  QueryContext context;
  NullProbe probe;
  CollideRequest first;
  first.mode = Mode::first_pair;
  std::vector<Approach> list;
  while (static_cast<int>(list.size()) < count) {
    Pose p;
    p.r = shapes::random_rotation(random);
    const Eigen::Vector3d d = shapes::random_direction(random);
    const auto meets = [&](double s) {
      p.t = s * d;
      return !collide(a, Pose{}, b, p, first, context, probe).pairs.empty();
    };
    const auto at = first_meeting(2 * diagonal, -2 * diagonal, 0.005 * diagonal, meets);
    if (!at) continue;
    p.t = *at * d;
    list.push_back({p, d});
  }
  return list;
}

/// Returns the least time of some runs, in microseconds.
template <class F>
double best_microseconds(int repeats, F&& f) {
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    f();
    best = std::min(
        best, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

}  // namespace lrb::bench
