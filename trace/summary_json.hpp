#pragma once

#include <string>

#include "trace/trace.hpp"

namespace lrb::trace {

/// Returns a run in numbers, as JSON: what `out/<name>/summary.json` holds and `--json` prints. Its members:
/// lrbscope, scenario, request, bodies, events, steps (index, relation, interiors_overlap, pairs,
/// fingerprint, the query's counters and the events' totals), totals, statistics and histograms, each with
/// its description; of a construction, from steps on, construction instead: patches, caps and regions, and
/// pass by pass. Ends with a line break. On the event clock, the same run gives the same bytes.
std::string summary_json(const Trace& trace);

}  // namespace lrb::trace
