#pragma once

#include <string>
#include <vector>

#include "scenarios/page/page.hpp"
#include "scenarios/play/frames.hpp"

namespace lrb {

/// What stands around the pictures of a run's page.
struct ReportText {
  std::string title, purpose, command;
  std::string trace_file;  ///< relative to the folder
  std::vector<std::string> mismatches;
};

/// Puts frames, whose files are in `folder`, into a page.
void add_frames(Page& page, const DrawnFrames& drawn, const std::string& folder);

/// A picture that is in the folder already, .svg or .png.
void add_figure(Page& page, const std::string& folder, const std::string& title, const std::string& caption,
                const std::string& file);

/// The page of a run whose files are in `folder`.
Page run_page(const Performance& performance, const DrawnFrames& drawn, const std::string& folder,
              const ReportText& text);

}  // namespace lrb
