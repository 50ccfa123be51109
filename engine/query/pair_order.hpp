#pragma once

#include <cstdint>
#include <vector>

#include "engine/query/collide.hpp"

namespace lrb {

/// Puts the pairs of an answer, and how they meet, in ascending order, and removes repetitions. Keeps its
/// memory from one answer to the next.
class PairOrder {
 public:
  void sort(CollideResult& result);

 private:
  void sort_keys(unsigned key_bits);
  void sort_by_digits(unsigned key_bits);

  /// A pair in as many bits as its numbers need, and how it meets in the last: all in one number, so that as
  /// little as can be is moved.
  std::vector<std::uint64_t> keys_, moved_;
  std::vector<std::uint32_t> places_;  ///< of each digit, of each of its values
};

}  // namespace lrb
