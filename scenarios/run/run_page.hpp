#pragma once

#include <string>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::run {

/// What stands around the pictures of a run's page.
struct ReportText {
  std::string title, purpose, command;
  std::string trace_file;  ///< relative to the folder
  std::vector<std::string> mismatches;
  /// The command that explains a pair of this run, but for --step and --pair; empty: there is none.
  std::string why = {};
};

/// Puts frames, whose files are in `folder`, into a page. `budget`: see inline_pngs().
void add_frames(report::Page& page, const DrawnFrames& drawn, const std::string& folder,
                std::size_t budget = report::kInlineBudget);

/// Puts a picture that is in the folder already, .svg or .png, into a page.
void add_figure(report::Page& page, const std::string& folder, const std::string& title,
                const std::string& caption, const std::string& file);
/// Puts an .svg that is in the folder already into a page as markup: its parts say what they are under the
/// pointer.
void add_live_figure(report::Page& page, const std::string& folder, const std::string& title,
                     const std::string& caption, const std::string& file);

/// Makes the page of a run whose files are in `folder`.
report::Page run_page(const RecordedRun& recorded, const DrawnFrames& drawn, const std::string& folder,
                      const ReportText& text);

}  // namespace lrb::run
