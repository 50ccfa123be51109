#pragma once
/// Derived bounds on rounding, each as a row {name, how much of the bound an input uses}. A search drives the
/// share up. It may not exceed 1, and must end between the row's `least` and 3 times that, so that a test
/// fails if the bound is too small, if its constant is cut to a third, and if it is needlessly large.

#include <algorithm>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"

namespace lrb::test {

struct Margin {
  const char* name;
  std::size_t genes;  ///< numbers in [0, 1) that make an input
  /// Returns the deviation of a float expression from its exact value, over the bound that is stated for it.
  double (*share)(std::span<const double> genes);
  double least = 1.0 / 3;
  int tries = 20'000;
};

/// A vector with coordinates from -1 to 1.
inline Eigen::Vector3d vector_of(std::span<const double> genes) {
  return {2 * genes[0] - 1, 2 * genes[1] - 1, 2 * genes[2] - 1};
}

/// Searches by chance, and from the best input so far by changes of one gene, large and small.
inline double worst_share(const Margin& margin) {
  shapes::RandomEngine random(1);
  std::vector<double> best(margin.genes), now;
  double most = 0;
  for (int i = 0; i < margin.tries; ++i) {
    now = best;
    if (i < margin.tries / 10)
      for (double& x : now) x = shapes::uniform(random);
    else
      for (auto changes = 1 + random() % 2; changes > 0; --changes) {
        double& x = now[random() % now.size()];
        const double by = random() % 2 == 0 ? 1 : 0x1p-40 * static_cast<double>(random() % 1024);
        x = std::clamp(by == 1 ? shapes::uniform(random) : x + by - 0x1p-31, 0.0, 1 - 0x1p-53);
      }
    const double share = margin.share(now);
    REQUIRE(share <= 1);
    if (share < most) continue;
    most = share;
    best = now;
  }
  return most;
}

inline void check_margins(std::span<const Margin> rows) {
  for (const Margin& row : rows) {
    CAPTURE(row.name);
    const double share = worst_share(row);
    MESSAGE(row.name, ": ", share, " of the bound is used");
    CHECK(share > row.least);
    CHECK(share < 3 * row.least);
  }
}

}  // namespace lrb::test
