#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace lrb {

/// Union-find with path halving. The smallest number leads each set, so that results do not depend on the
/// order of unions.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) { reset(count); }

  /// Makes each number a set of its own.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  /// Returns the smallest number in the set of i.
  std::uint32_t leader(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Unites the sets of i and j. Returns true if they were different.
  bool join(std::uint32_t i, std::uint32_t j) {
    i = leader(i);
    j = leader(j);
    if (i == j) return false;
    parent_[i < j ? j : i] = i < j ? i : j;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace lrb
