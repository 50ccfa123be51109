#pragma once

#include <vector>

#include "engine/query/collide.hpp"

namespace lrb::bench {

/// Returns every pair of real triangles that meets: by a sweep over boxes in the world, and exact tests of
/// what is left. Shares with the query the predicates and the definition of world coordinates, and nothing
/// else.
std::vector<SimplexPair> exact_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                     const Pose& pose_b);

}  // namespace lrb::bench
