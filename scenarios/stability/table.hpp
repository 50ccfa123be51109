#pragma once

#include <string>

#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

/// Returns the grid as text: a row for each family; in each cell failures/answered and the dial setting from
/// which on it fails; and what the columns mean.
std::string table(const Grid& grid);

}  // namespace lrb::stability
