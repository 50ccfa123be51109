#pragma once

#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"

namespace lrb::golden {

/// Makes a run the golden. Leaves files alone that say the same already; where a picture has changed, removes
/// its old variants. With `variant` the trace must be the approved one already, and pictures that differ are
/// put beside the approved ones. Returns what was done, a line for each file; throws InputError.
std::vector<std::string> approve_golden(const std::string& goldens, const GoldenSpec& spec,
                                        const GoldenRun& run, const std::string& variant);

}  // namespace lrb::golden
