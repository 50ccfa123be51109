#pragma once

#include <vector>

#include "scenarios/report/page/page.hpp"
#include "scenarios/run/frame_job.hpp"

namespace lrb::run {

/// Puts a construction into its page: its numbers, charts of the hull and of caps, and tables of its passes
/// and of why caps were refused.
void add_construction(report::Page& page, const RecordedRun& recorded);

}  // namespace lrb::run
