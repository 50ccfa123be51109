#pragma once

#include <cstdint>
#include <utility>

namespace lrb {

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers from the same seed with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// 0 .. bound - 1 (bound > 0), all but equally likely.
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((next() >> 32) * bound) >> 32);
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
