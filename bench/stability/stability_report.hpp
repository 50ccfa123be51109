#pragma once
/// Reports the grid of families x methods as a page that opens from disk, and as charts for print.

#include <functional>
#include <string>
#include <vector>

#include "bench/stability/outcome_grid.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::stability {

struct ReportOptions {
  /// (|cells|) PNG of each cell's worst case, relative to the folder. No picture for an empty path or an
  /// empty list.
  std::vector<std::string> pictures;
  /// Returns the command that runs one case again; may be null.
  std::function<std::string(const Record&)> command;
  std::vector<report::Link> links;  ///< such as one to the raw records
  bool tex = false;                 ///< also write grid.tex, the table for LaTeX
};

/// Writes index.html, grid.csv with the counts by difficulty, and the chart stability-profiles (failures by
/// difficulty, per family) as .svg and .png. Without gnuplot only the page and the counts are written, and
/// the document's notes report it. Throws InputError if the sizes of the grid's arrays do not match,
/// EnvironmentError if a file cannot be written.
report::Document write_stability_report(const Grid& grid, const report::Folder& folder,
                                        const ReportOptions& options = {});

/// Returns the outcome of a case as text.
std::string answer_text(const Record& r);

/// Returns only the page, with pictures read from the folder.
report::Document stability_page(const Grid& grid, const std::string& folder,
                                const ReportOptions& options = {});

}  // namespace lrb::stability
