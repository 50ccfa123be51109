#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/query/collide.hpp"

namespace lrb {

/// Puts pairs in ascending order and removes repetitions. Keeps its memory from one call to the next.
class PairOrder {
 public:
  /// The pairs of an answer, and how they meet.
  void sort(CollideResult& result);
  void sort(std::vector<SimplexPair>& pairs);

 private:
  /// How a pair is packed in one number: in as many bits as its numbers need, and how it meets in the last.
  struct Packing {
    unsigned bits_b, bits;
  };
  Packing packing_of(std::span<const SimplexPair> pairs) const;
  void sort_keys(unsigned bits);
  void sort_by_digits(unsigned bits);

  std::vector<std::uint64_t> keys_, moved_;  ///< packed, so that as little as can be is moved
  std::vector<std::uint32_t> places_;        ///< of each digit, of each of its values
};

}  // namespace lrb
