#pragma once

#include <functional>

#include "engine/tree/obb_tree.hpp"

namespace lrb {

/// Calls visit(s, t), s < t, for all pairs of a tree's simplices, in the body's own frame, that float
/// arithmetic could not prove disjoint: all that meet, and a few that do not. In an unspecified order.
void for_each_self_pair(const ObbTree& tree, const std::function<void(SimplexId, SimplexId)>& visit);

}  // namespace lrb
