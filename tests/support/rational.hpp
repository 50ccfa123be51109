#pragma once
/// Distances of surfaces in rational arithmetic.

#include "bench/stability/rational_oracles.hpp"
#include "tests/support/simplex_distance.hpp"

namespace lrb::test {

/// The squared distance of surfaces that do not pass through each other: of the pairs that are nearest in
/// doubles, exactly.
inline oracle::Rational surface_distance_sq(const std::vector<Points>& a, const std::vector<Points>& b) {
  // The oracle in doubles loses digits for large coordinates: a generous bound on its error.
  double size = 0;
  for (const auto* surface : {&a, &b})
    for (const Points& simplex : *surface)
      for (const Eigen::Vector3d& x : simplex) size = std::max(size, x.cwiseAbs().maxCoeff());
  const double about = surface_distance(a, b) * (1 + 1e-7) + 1e-7 * size;
  oracle::Rational least = -1;
  for (const Points& s : a)
    for (const Points& t : b) {
      if ((s[0] - t[0]).norm() * (1 - 1e-12) - reach(s) - reach(t) > about) continue;
      const double apart = simplex_distance(s, t);
      if (apart > about) continue;
      if (least >= 0 && oracle::square(apart * (1 - 1e-6)) > least && apart > 1e-5 * size) continue;
      const oracle::Rational sq = oracle::distance_sq(s, t);
      if (least < 0 || sq < least) least = sq;
    }
  return least;
}

}  // namespace lrb::test
