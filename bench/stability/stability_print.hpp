#pragma once
/// Draws the grid and its profiles for print, with gnuplot.

#include <string>
#include <vector>

#include "bench/stability/outcome_grid.hpp"
#include "scenarios/report/gnuplot.hpp"

namespace lrb::stability {

report::Gnuplot grid_chart(const Grid& grid);
/// Makes one small chart for each family: share of failures against the dial, a line for each method that is
/// present.
report::Gnuplot profile_chart(const Grid& grid);

struct PrintFile {
  std::string name, what;
};

/// Writes both as SVG and PNG. Throws EnvironmentError if gnuplot is missing or fails.
std::vector<PrintFile> print_stability(const Grid& grid, const std::string& folder);

}  // namespace lrb::stability
