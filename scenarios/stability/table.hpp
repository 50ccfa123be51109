#pragma once

#include <string>

#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

/// The grid as text: a row for each family, failures/answered in each cell, from which setting of the dial on
/// it fails, and what the columns mean.
std::string table(const Grid& grid);

}  // namespace lrb::stability
