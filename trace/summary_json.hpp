#pragma once

#include <string>

#include "trace/trace.hpp"

namespace lrb::trace {

/// A run in numbers, as JSON: `out/<name>/summary.json` and what `--json` prints. Members: lrbscope,
/// scenario, request, bodies, events, steps (index, relation, interiors_overlap, pairs, fingerprint, the
/// query's counters and the events' totals), totals, statistics and histograms, each with its description.
/// Ends with a line break. Byte for byte the same for the same run on the event clock.
std::string summary_json(const Trace& trace);

}  // namespace lrb::trace
