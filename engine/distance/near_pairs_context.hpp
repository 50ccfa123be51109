#pragma once
/// A search for near pairs, with buffers that later searches reuse. Internal: users of the installed engine
/// include near_pairs.hpp.

#include <vector>

#include "engine/collide/pair_order.hpp"
#include "engine/tree/tree_kernel.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

/// Buffers of a search.
struct NearPairsContext {
  std::vector<NodePair> stack;   ///< of the traversal
  std::vector<Candidate> found;  ///< by the traversal since it last stopped
  std::vector<SimplexPair> candidates;
  PairOrder order;
  std::vector<std::vector<NearPair>> near;  ///< (chunks of candidates) with several threads
};

/// Finds the pairs as near_pairs() does. `context`: buffers. `result`: overwritten; its memory is reused.
void near_pairs_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const NearPairsRequest& request, Workers& workers, NearPairsContext& context,
                     NearPairsResult& result);

}  // namespace lrb
