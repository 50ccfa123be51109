#pragma once

#include <string>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::run {

/// Texts and links around the pictures of a run's page.
struct ReportText {
  std::string title, purpose, command;
  std::string trace_file;  ///< relative to the folder
  std::vector<report::Link> links = {};
  std::vector<std::string> mismatches = {};
  /// The command that explains a pair of this run, without --step and --pair; may be empty.
  std::string why = {};
};

/// Returns the link to a trace.
report::Link trace_link(const std::string& file);

/// Builds the page of a run whose files are in `folder`.
report::Document run_page(const frames::RecordedRun& recorded, const frames::DrawnFrames& drawn,
                          const std::string& folder, const ReportText& text);

}  // namespace lrb::run
