#pragma once

#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"
#include <lrbscope/trace/divergence.hpp>

namespace lrb::golden {

// Finds what may be behind a difference from what was approved: another scenario, other bodies, or neither.

/// Returns one line for each thing that is not as it was approved and that what follows depends on: the
/// scenario's file, a body's mesh, how its LRB-rep was built, the request, a pose, the version of lrbscope.
std::vector<std::string> find_causes(const Golden& golden, const GoldenRun& run);

/// Tells what happened at a divergence from the events that follow it in its step: events swapped, lost,
/// added or replaced. Returns one line; empty if it is not about an event.
std::string diagnose(const trace::Trace& expected, const trace::Trace& actual,
                     const trace::Divergence& divergence);

}  // namespace lrb::golden
