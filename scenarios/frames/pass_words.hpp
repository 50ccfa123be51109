#pragma once
/// Texts about a construction, for frames and pages.

#include <cstdint>
#include <string>

#include <lrbscope/trace/counters.hpp>

namespace lrb::run {

/// Returns the results of a pass: "pass 3: 47 regions, 1 064 to 340 faces, 12 caps refused: 9 met the hull, 3
/// too thick".
std::string pass_words(const trace::PassSummary& pass);

/// Returns the purpose of a pass: "fitting, caps at most 0.002 off the body".
std::string stage_words(const trace::PassSummary& pass);

/// Returns the text of a construction event.
std::string built_words(const trace::Event& e);

}  // namespace lrb::run
