#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace lrb {

/// Union-find with path halving: sets that can be joined but not split. The smaller number always leads, so
/// that results do not depend on the order of the joins.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t leader(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins the sets of i and j. Returns true if they were two different sets until now.
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
