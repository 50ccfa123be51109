#pragma once
/// The grid of families x methods for people: a page that opens from disk, and the same for print.

#include <functional>
#include <string>
#include <vector>

#include "scenarios/report/page/page.hpp"
#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

struct ReportOptions {
  /// (|cells|) PNG of each cell's worst case, relative to the folder; empty ones, or none at all: no picture.
  std::vector<std::string> pictures;
  /// The command that shows one case again. Nothing: none is given.
  std::function<std::string(const Record&)> command;
  std::vector<report::PageLink> links;  ///< the raw records, for one
};

struct ReportFiles {
  std::vector<std::string> written;  ///< relative to the folder
  std::string missing;               ///< one line on what could not be drawn for want of gnuplot; else empty
};

/// index.html, and stability.svg, .png (the grid), stability-profiles.svg, .png (failures along the dial,
/// family by family). Without gnuplot, the page alone. Throws InputError if the grid's arrays do not fit
/// together, EnvironmentError if a file cannot be written.
ReportFiles write_stability_report(const Grid& grid, const std::string& folder,
                                   const ReportOptions& options = {});

/// What became of a case, in words.
std::string answer_text(const Record& r);

/// The page alone, with pictures read from the folder.
report::Page stability_page(const Grid& grid, const std::string& folder, const ReportOptions& options = {});

}  // namespace lrb::stability
