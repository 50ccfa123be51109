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
  std::vector<report::Link> links;  ///< such as one to the raw records
};

/// Writes index.html, and as .svg and .png stability (the grid) and stability-profiles (failures by
/// difficulty, family by family). Without gnuplot it writes the page alone, and the document's notes say so.
/// Throws InputError if the grid's arrays do not fit together, EnvironmentError if a file cannot be written.
report::Document write_stability_report(const Grid& grid, const report::Folder& folder,
                                        const ReportOptions& options = {});

/// The grid, and for each family a chart of failures by difficulty with a line for each method that is
/// present.
report::Gnuplot grid_chart(const Grid& grid);
report::Gnuplot profile_chart(const Grid& grid);

/// Returns the outcome of a case as text.
std::string answer_text(const Record& r);

/// Makes the page alone, with pictures read from the folder.
report::Document stability_page(const Grid& grid, const std::string& folder,
                                const ReportOptions& options = {});

}  // namespace lrb::stability
