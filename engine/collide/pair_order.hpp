#pragma once

#include <cstdint>
#include <vector>

#include <lrbscope/collide.hpp>

namespace lrb {

/// Sorts pairs in ascending order and removes repetitions; each time a pair occurs, it must meet in the same
/// way. Keeps its memory from one call to the next.
class PairOrder {
 public:
  /// Sorts the pairs of an answer, and with them how they meet.
  void sort(CollideResult& result);
  void sort(std::vector<SimplexPair>& pairs);

 private:
  void sort_keys(unsigned bits_b, unsigned bits);
  void sort_by_digits(unsigned first, unsigned end);

  std::vector<std::uint64_t> keys_, moved_;  ///< packed pairs, so that as little as possible is moved
  /// (digits x values of a digit) where the next key with that value goes.
  std::vector<std::uint32_t> places_;
};

}  // namespace lrb
