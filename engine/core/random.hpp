#pragma once

#include <cstdint>
#include <utility>

namespace lrb {

/// SplitMix64 (Steele, Lea and Flood 2014). Gives the same numbers for the same seed on every machine and
/// with every standard library, unlike the distributions of <random>.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Returns 64 random bits.
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Returns a uniformly distributed number in [least, most).
  double in(double least, double most) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53: a double has 53 bits
    return least + (most - least) * static_cast<double>(bits() >> 11) * kUnit;
  }
  /// Returns a number in 0 .. bound - 1 (bound > 0), uniformly distributed to within 2^-32.
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((bits() >> 32) * bound) >> 32);
  }
  /// Puts the elements in random order.
  template <class Vector>
  void shuffle(Vector& elements) {
    for (auto i = static_cast<std::uint32_t>(elements.size()); i > 1; --i)
      std::swap(elements[i - 1], elements[below(i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace lrb
