#pragma once
/// Tables of a run's page: counters by level and by region of both bodies.

#include <vector>

#include "scenarios/report/page/page.hpp"
#include "scenarios/run/frame_job.hpp"

namespace lrb::run {

/// Returns the counters by level, and those of the regions with the most tests, for each body; none for a run
/// of one body.
std::vector<report::PageTable> group_tables(const RecordedRun& run);

}  // namespace lrb::run
