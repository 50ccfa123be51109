#pragma once
/// Another engine's walk as a recorded run, so that all that draws and counts ours does the same for it.

#include <cstdint>
#include <vector>

#include "scenarios/run/recorded_run.hpp"
#include "scenarios/xray/foreign_walk.hpp"

namespace lrb::xray {

/// Returns a recording of the walk at the steps of `ours`, with its bodies. The results are those of `ours`,
/// so that pictures show where the bodies really meet; what the other engine answered stands in the trace. A
/// pair of bounding volumes is a node pair with one test, `met` is the number of pairs that the engine goes
/// on to.
run::Recording recording_of(const ForeignWalk& walk, const run::Recording& ours,
                            const spec::Scenario& scenario);

/// Pairs that an engine reported and that do not meet, and pairs that meet and it did not report.
struct WrongPairs {
  std::vector<SimplexPair> too_many, missing;  ///< ascending
};
/// Compares the pairs of a step with the exact ones, which must be ascending.
WrongPairs wrong_pairs(const ForeignStep& step, const std::vector<SimplexPair>& exact);

}  // namespace lrb::xray
