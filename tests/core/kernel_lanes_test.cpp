// Operations of the kernels on vectors, in the version of this processor's baseline, against scalar code.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <doctest/doctest.h>

#include "engine/distance/kernel_doubles.inl"
#include <lrbscope/core/random.hpp>

using namespace lrb;

namespace {

/// Also NaN, zeros of both signs and equal numbers.
float lane_value(Random& random) {
  constexpr float kSpecial[] = {std::numeric_limits<float>::quiet_NaN(), 0.0f, -0.0f, 1.0f};
  const std::uint32_t kind = random.below(10);
  return kind < 4 ? kSpecial[kind] : static_cast<float>(random.in(-8, 8));
}

bool same_bits(float x, float y) {
  return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
}

}  // namespace

TEST_CASE("vectors of floats compute what scalars compute") {
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    Float8 x, y;
    std::uint8_t bytes[8];
    for (int k = 0; k < 8; ++k) {
      x[k] = lane_value(random);
      y[k] = random.below(4) == 0 ? x[k] : lane_value(random);
      bytes[k] = static_cast<std::uint8_t>(random.below(256));
    }
    const Lanes lanes = greater(x, y);
    const Float8 maximum = larger(x, y);
    const Int8 integers = bytes_to_int(bytes);
    Float8 magnitude = abs8(x);
    bool equal = true;
    for (int k = 0; k < 8; ++k) {
      equal &= (bits(lanes) >> k & 1) == (x[k] > y[k] ? 1u : 0u) &&
               same_bits(maximum[k], x[k] > y[k] ? x[k] : y[k]) && integers[k] == bytes[k] &&
               same_bits(magnitude[k], std::abs(x[k]));
      if (std::isnan(magnitude[k])) magnitude[k] = 2;
    }
    float most = 0;
    const Float8 root = root8(magnitude);
    for (int k = 0; k < 8; ++k) {
      most = std::max(most, magnitude[k]);
      equal &= same_bits(root[k], std::sqrt(magnitude[k]));
    }
    REQUIRE(equal);
    REQUIRE(largest_of(magnitude) == most);
  }
}

TEST_CASE("vectors of doubles compute what scalars compute") {
  Random random(2);
  for (int i = 0; i < 20'000; ++i) {
    Doubles x, y;
    for (int k = 0; k < kDoubles; ++k) {
      x[k] = static_cast<double>(lane_value(random));
      y[k] = static_cast<double>(lane_value(random));
    }
    const DoubleLanes lanes = greater(x, y);
    const Doubles root = root8(abs8(x));
    for (int k = 0; k < kDoubles; ++k) {
      REQUIRE((bits(lanes) >> k & 1) == (x[k] > y[k] ? 1u : 0u));
      REQUIRE((std::isnan(x[k]) || root[k] == std::sqrt(std::abs(x[k]))));
    }
  }
}
