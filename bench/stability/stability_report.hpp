#pragma once
/// Reports the grid of families x methods to people: a page that opens from disk, and the same for print.

#include <functional>
#include <string>
#include <vector>

#include "bench/stability/outcome_grid.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::stability {

struct ReportOptions {
  /// (|cells|) PNG of each cell's worst case, relative to the folder. An empty path, or an empty list: no
  /// picture.
  std::vector<std::string> pictures;
  /// Returns the command that shows one case again; may be null.
  std::function<std::string(const Record&)> command;
  std::vector<report::PageLink> links;  ///< such as one to the raw records
};

struct ReportFiles {
  std::vector<std::string> written;  ///< relative to the folder
  std::string missing;  ///< one line on what could not be drawn because gnuplot is missing; else empty
};

/// Writes index.html, and as .svg and .png stability (the grid) and stability-profiles (failures along the
/// dial, family by family). Without gnuplot it writes the page alone. Throws InputError if the grid's arrays
/// do not fit together, EnvironmentError if a file cannot be written.
ReportFiles write_stability_report(const Grid& grid, const std::string& folder,
                                   const ReportOptions& options = {});

/// Says in words what became of a case.
std::string answer_text(const Record& r);

/// Makes the page alone, with pictures read from the folder.
report::Page stability_page(const Grid& grid, const std::string& folder, const ReportOptions& options = {});

}  // namespace lrb::stability
