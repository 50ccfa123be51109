#pragma once

#include <cstdint>
#include <vector>

#include "engine/query/walk/result.hpp"

namespace lrb {

/// Puts pairs in ascending order and removes repetitions. Keeps its memory from one call to the next.
class PairOrder {
 public:
  /// The pairs of an answer, and how they meet.
  void sort(CollideResult& result);
  void sort(std::vector<SimplexPair>& pairs);

 private:
  void sort_keys(unsigned bits);
  void sort_by_digits(unsigned bits);

  std::vector<std::uint64_t> keys_, moved_;  ///< packed, so that as little as can be is moved
  std::vector<std::uint32_t> places_;        ///< of each digit, of each of its values
};

}  // namespace lrb
