#pragma once

#include <vector>

#include "engine/query/collide.hpp"

namespace lrb {

/// Tests every pair of real simplices exactly: the slow answer that the fast one is compared with. It shares
/// the predicates and the definition of world coordinates with the query, and nothing else: no tree, no
/// boxes. Throws InputError beyond kMostPairs.
struct BruteForceResult {
  std::vector<SimplexPair> pairs;  ///< ascending
  std::vector<exact::Meet> meets;  ///< (|pairs|)
  Relation relation = Relation::separate;
};

BruteForceResult brute_force(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);

}  // namespace lrb
