#pragma once

#include <cstdint>
#include <vector>

#include <lrbscope/collide.hpp>

namespace lrb {

/// Sorts pairs in ascending order and removes repetitions. A pair that occurs several times must have the
/// same Meet each time. Its buffers keep their memory from one call to the next.
class PairOrder {
 public:
  /// Sorts the pairs of a result together with their entries in `meets`.
  void sort(CollideResult& result);
  void sort(std::vector<SimplexPair>& pairs);

 private:
  void sort_keys(unsigned bits_b, unsigned bits);
  void sort_by_digits(unsigned first, unsigned end);

  std::vector<std::uint64_t> keys_, moved_;  ///< packed pairs: a pass moves 8 bytes a pair
  /// (passes x digit values) the index to which the next key with that digit value is moved.
  std::vector<std::uint32_t> places_;
};

}  // namespace lrb
