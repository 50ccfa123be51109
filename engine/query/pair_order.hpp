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
  struct Found {
    SimplexPair pair;
    exact::Meet meet;
  };
  void sort_by_digits(SimplexId most_a, SimplexId most_b);
  void sort_by_digit(SimplexId SimplexPair::*id, unsigned shift);

  std::vector<Found> found_, moved_;
};

}  // namespace lrb
