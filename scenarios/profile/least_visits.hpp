#pragma once
/// The least number of visits that a descent of two trees needs, whichever node it opens at each pair.

#include <cstdint>
#include <optional>

#include "scenarios/profile/pair_map.hpp"
#include "scenarios/profile/query_walk.hpp"

namespace lrb::profile {

/// The pairs of nodes that a search for the least number may look at, and the levels of both trees together.
/// Beyond them there is no answer.
inline constexpr std::size_t kMaxPairs = 50'000'000;
inline constexpr std::uint32_t kMaxLevels = 4000;

/// Returns the least number of visits that any order of descent needs with the volumes of these trees;
/// nullopt beyond kMaxPairs or kMaxLevels.
///
/// A descent begins where the recorded one did, usually with both roots. At a pair whose volumes overlap it
/// opens A's node, or B's, or both if the recorded engine ever did so. It then visits all pairs of children
/// (QueryWalk::wide(): those whose volumes overlap, because they were compared before). The order in which
/// pairs are visited makes no difference: it visits until nothing is left, so this is not for queries that
/// may end early.
///
/// Recorded tests are taken as they are. Other volumes are compared by overlap().
///
/// Dynamic programming over pairs of nodes: the least number beneath a pair is 1, plus that of the pairs of
/// children for the best choice. Parts of a choice that cannot become the best are skipped.
std::optional<std::uint64_t> least_visits(CapturedBodies& bodies, const QueryWalk& walk);

}  // namespace lrb::profile
