#pragma once
/// A construction in words, for frames and pages.

#include <cstdint>
#include <string>

#include <lrbscope/trace/counters.hpp>

namespace lrb::run {

/// Returns what a pass made: "pass 3: 47 regions, 1 064 to 340 faces, 12 caps refused: 9 met the hull, 3 too
/// thick".
std::string pass_words(const trace::PassSummary& pass);

/// Returns what a pass was about: "fitting, caps at most 0.002 off the body".
std::string stage_words(const trace::PassSummary& pass);

/// Returns what an event of a construction says.
std::string built_words(const trace::Event& e);

}  // namespace lrb::run
