// stable_norm3: the length of a vector, also where its squares overflow or underflow.
#include "engine/core/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "engine/core/extended.hpp"

using namespace lrb;
using Eigen::Vector3d;

TEST_CASE("lengths of vectors of any size") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int exponent = -1074; exponent <= 1022; ++exponent) {
    Vector3d x;
    for (int k = 0; k < 3; ++k) x[k] = std::ldexp(coordinate(random), exponent);
    // 64 bits and unlimited exponents: no overflow, and a rounding error far below that of a double.
    SoftExtended sum(0);
    for (int k = 0; k < 3; ++k) sum += SoftExtended(x[k]) * SoftExtended(x[k]);
    const double expected = static_cast<double>(sqrt(sum));
    const double least = std::numeric_limits<double>::denorm_min();
    CHECK(std::abs(stable_norm3(x) - expected) <= std::max(4 * least, expected * 0x1p-50));
  }
}

TEST_CASE("the length of a zero, infinite or undefined vector") {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  CHECK(stable_norm3(Vector3d::Zero()) == 0);
  CHECK(stable_norm3({0, -kInfinity, 1}) == kInfinity);
  for (const double other : {0.0, 2.0})
    for (int k = 0; k < 3; ++k) {
      Vector3d x = Vector3d::Constant(other);
      x[k] = kNaN;
      CHECK(std::isnan(stable_norm3(x)));
    }
}
