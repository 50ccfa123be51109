#pragma once
/// Pictures of the paper's report: written as files, and put into its page.

#include "scenarios/paper/paper_report.hpp"
#include "scenarios/report/page/page.hpp"

namespace lrb::paper {

/// Throws InputError if the steps are not those of the experiment, as far as the numbers of collisions and
/// its close-ups tell.
void check_records(const PaperReport& report);

/// Draws heat maps of the easiest and the hardest collision, and the refinement tree of the hardest one's
/// busiest step, each if the experiment reports it. Adds what could not be drawn to `notes`.
void draw_close_ups(const PaperReport& report, const std::string& folder, report::Page& page,
                    std::vector<std::string>& notes);

}  // namespace lrb::paper
