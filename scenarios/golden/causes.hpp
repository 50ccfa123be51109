#pragma once
/// Finds what may be behind a difference from what was approved: another scenario, other bodies, or neither.

#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"

namespace lrb::golden {

/// Returns one line for each thing that is not as it was approved and that what follows depends on: the
/// scenario's file, a body's mesh, how its LRB-rep was built, the request, a pose, the version of lrbscope.
std::vector<std::string> find_causes(const Golden& golden, const GoldenRun& run);

}  // namespace lrb::golden
