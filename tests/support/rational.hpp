#pragma once
/// Simplices of bodies for the oracles in rational arithmetic.

#include "bench/stability/rational_oracles.hpp"
#include "tests/support/simplex_distance.hpp"

namespace lrb::test {

/// Returns the real simplices of a body in the world.
inline std::vector<Points> real_simplices(const LrbRep& rep, const Pose& pose) {
  std::vector<Points> out;
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) out.push_back(simplex_points(rep, pose, s));
  return out;
}

}  // namespace lrb::test
