#pragma once

#include <cstdint>

namespace lrb {

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers on every machine and standard library, unlike
/// <random>'s distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// In [least, most).
  double in(double least, double most) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53: a double has 53 bits
    return least + (most - least) * static_cast<double>(bits() >> 11) * kUnit;
  }

 private:
  std::uint64_t state_;
};

}  // namespace lrb
