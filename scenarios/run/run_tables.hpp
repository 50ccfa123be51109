#pragma once
/// Tables of a run's page: counters by level and by region of both bodies.

#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::run {

/// Returns the counters by level, and those of the regions with the most tests, for each body; none for a run
/// of one body.
std::vector<report::PageTable> group_tables(const RecordedRun& run);

// Tables of a run's page: where the work of its queries went, and how good the bodies' trees and LRB-reps
// are.

/// Returns the parts of the queries with what each cost, and the walk by depth of each body's tree beside
/// what the surface area heuristic expects; none for a trace without these events.
std::vector<report::PageTable> work_tables(const RecordedRun& run);

/// Returns the quality sheet of the bodies.
report::PageTable quality_table(const RecordedRun& run);

}  // namespace lrb::run
