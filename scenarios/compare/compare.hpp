#pragma once
/// Two recorded runs side by side: their answers and work step by step, or how their bodies were built.

#include <optional>
#include <string>

#include "scenarios/compare/side_by_side.hpp"

namespace lrb::compare {

/// Writes folder/index.html and folder/compare.png: what differs first, answers and work step by step, and
/// where the work went in each. Of runs of one body: how the front or the wrapper changed, and the regions of
/// both. Returns where the runs begin to differ: their bodies and requests, and the first event or answer
/// that is not the same; nullopt if they are the same. Throws InputError if one run is of one body and the
/// other of two.
std::optional<std::string> write_comparison(const Runs& runs, const std::string& command,
                                            const std::string& folder, const run::ProgressReport& progress);

}  // namespace lrb::compare
