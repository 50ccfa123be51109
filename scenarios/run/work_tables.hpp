#pragma once
/// Tables of a run's page: where the work of its queries went, and how good the bodies' trees and LRB-reps
/// are.

#include <vector>

#include "scenarios/report/page/page.hpp"
#include "scenarios/run/frame_job.hpp"

namespace lrb::run {

/// Returns the parts of the queries with what each cost, and the walk by depth of each body's tree beside
/// what the surface area heuristic expects; none for a trace without these events.
std::vector<report::PageTable> work_tables(const RecordedRun& run);

/// Returns the quality sheet of the bodies.
report::PageTable quality_table(const RecordedRun& run);

}  // namespace lrb::run
