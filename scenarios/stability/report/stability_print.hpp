#pragma once
/// The grid and its profiles for print, drawn by gnuplot.

#include <string>
#include <vector>

#include "scenarios/report/charts/gnuplot.hpp"
#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

report::Gnuplot grid_chart(const Grid& grid);
/// One small chart per family: share of failures against the dial, a line per method that is present.
report::Gnuplot profile_chart(const Grid& grid);

struct PrintFile {
  std::string name, what;
};

/// Writes both as SVG and PNG. Throws EnvironmentError if gnuplot is missing or fails.
std::vector<PrintFile> print_stability(const Grid& grid, const std::string& folder);

}  // namespace lrb::stability
