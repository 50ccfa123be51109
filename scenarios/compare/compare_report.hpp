#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/report/page/page.hpp"

namespace lrb::compare {

/// Returns where the two runs begin to differ, in words: their bodies and requests, and the first event or
/// answer that is not the same; nothing if they are the same.
std::optional<std::string> first_difference(const Runs& runs);

/// Returns the views of both runs' pages for a page in `folder`; none if one of them has no page.
std::vector<report::PageView> views_of(const Runs& runs, const std::string& folder);

/// Writes folder/index.html and folder/compare.png: what differs first, answers and work step by step, and
/// where the work went in each. Of runs of one body: how the hull or the wrapper changed, and the regions of
/// both. Returns first_difference(). Throws InputError if one run is of one body and the other of two.
std::optional<std::string> write_comparison(const Runs& runs, const std::string& command,
                                            const std::string& folder, const run::ProgressReport& progress);

}  // namespace lrb::compare
