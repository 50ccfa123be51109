#pragma once

#include <functional>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// Calls visit(s, t), s < t, for all pairs of real simplices of a body in its own frame that float arithmetic
/// could not prove apart: all that meet, and a few that do not. In no particular order.
void for_each_self_pair(const LrbRep& rep, const std::function<void(SimplexId, SimplexId)>& visit);

}  // namespace lrb
