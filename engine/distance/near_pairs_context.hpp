#pragma once
/// A search for near pairs, with buffers that later searches reuse. Internal: users of the installed engine
/// include near_pairs.hpp.

#include <vector>

#include "engine/collide/pair_order.hpp"
#include "engine/collide/query_context.hpp"
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

/// Buffers of a search.
struct NearPairsContext {
  std::vector<SimplexPair> candidates;
  PairOrder order;
  // With several threads:
  std::vector<WorldVertices> worlds;        ///< (2 x threads)
  std::vector<std::vector<NearPair>> near;  ///< (chunks of candidates)
};

/// Finds the pairs as near_pairs() does. `query`, `context`: buffers. `result`: overwritten; its memory is
/// reused.
void near_pairs_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const NearPairsRequest& request, Workers& workers, QueryContext& query,
                     NearPairsContext& context, NearPairsResult& result);

}  // namespace lrb
