#pragma once
/// Ways to find out when moving bodies first meet, for sweep_bench: ours, exact queries at equal times,
/// FCL's.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/bench/sweep_motions.hpp"

namespace lrb::bench {

/// What a method says of one motion. Goes through a pipe as it is.
struct SweepAnswer {
  bool contact = false;
  bool undecided = false;
  double t0 = 1, t = 1;  ///< the contact is found at t; t0: proved not to be before it, else t
  double microseconds = 0;
};

/// Asks one method about motions of one family. What it keeps between motions is built outside of the clock.
using SweepAsker = std::function<SweepAnswer(const SweptMotion&)>;

struct SweepMethod {
  std::string name;
  bool straight_only = false;
  std::function<SweepAsker(const SweptFamily&)> make;
};

/// Returns ours and sampled exact queries.
std::vector<SweepMethod> own_sweep_methods();
/// Returns those of FCL's continuousCollide() that take meshes; none if it is not there.
std::vector<SweepMethod> fcl_sweep_methods();

}  // namespace lrb::bench
