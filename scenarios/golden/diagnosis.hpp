#pragma once

#include <string>

#include "trace/divergence.hpp"

namespace lrb::golden {

/// Tells what happened at a divergence from the events that follow it in its step: events swapped, lost,
/// added or replaced. Returns one line; empty if it is not about an event.
std::string diagnose(const trace::Trace& expected, const trace::Trace& actual,
                     const trace::Divergence& divergence);

}  // namespace lrb::golden
