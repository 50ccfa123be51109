#pragma once

#include <array>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// The real simplices across the borders of a real simplex: [e] across the edge from corner e to the next
/// one, in 2D beyond corner e. kNull where there is none.
using Across = std::array<SimplexId, 3>;

/// Returns what lies across the borders of each real simplex. Where more than two meet in one border, each
/// has one of the others across it.
std::vector<Across> real_neighbours(const LrbRep& rep);

}  // namespace lrb
