#pragma once

#include <string>

#include "trace/divergence.hpp"

namespace lrb::golden {

/// What happened at a divergence, told from the events that follow it in its step: events swapped, lost,
/// added or replaced. One line; empty if it is not about an event.
std::string diagnose(const trace::Trace& expected, const trace::Trace& actual,
                     const trace::Divergence& divergence);

}  // namespace lrb::golden
