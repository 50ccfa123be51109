#pragma once

#include <span>
#include <string>

#include "trace/trace.hpp"

namespace lrb::trace {

class TreeShape;

/// A recorded body, for the figures that need more than its trace.
struct SummaryBody {
  const LrbRep* rep = nullptr;
  const TreeShape* walked =
      nullptr;  ///< the tree that was walked, ours or another engine's; null: no walk was recorded
};

/// Returns a run in numbers, as JSON: what `out/<name>/summary.json` holds and `--json` prints. Its members:
/// lrbscope, scenario, request, bodies, events, steps (index, relation, interiors_overlap, pairs,
/// fingerprint, the query's counters and the events' totals), totals, statistics and histograms, each with
/// its description; of a construction, from steps on, construction instead: patches, caps and regions, and
/// pass by pass. With the recorded bodies, in the order of the trace, also quality (of trees and LRB-reps)
/// and, where walks were recorded, walk_by_depth (each tree's nodes, what the surface area heuristic expects
/// and what was visited). Ends with a line break. On the event clock, the same run gives the same bytes.
std::string summary_json(const Trace& trace, std::span<const SummaryBody> bodies = {});

}  // namespace lrb::trace
