#pragma once
/// Two recorded runs side by side: their answers and work step by step, or how their bodies were built.

#include <optional>
#include <string>

#include "scenarios/compare/side_by_side.hpp"

namespace lrb::compare {

struct Difference {
  /// Where the runs begin to differ: their bodies and requests, and the first differing event or answer;
  /// nullopt if they are equal.
  std::optional<std::string> first;
  std::string regions;  ///< of runs of one body: lines on their regions; else empty
};

/// Writes folder/index.html and folder/compare.png: the first difference, answers and work step by step, and
/// the distribution of the work in each run. For runs of one body: the changes of the front or the wrapper,
/// and the regions of both, matched by place (regions.hpp). Throws InputError if one run is of one body and
/// the other of two.
Difference write_comparison(const Runs& runs, const std::string& command, const std::string& folder,
                            const run::ProgressReport& progress);

}  // namespace lrb::compare
