#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include "trace/trace.hpp"

namespace lrb::run {

/// Returns the events after which pictures are taken, ascending, at most spec.most of them. Throws InputError
/// for events that the trace does not have, and for passes of what is no construction.
std::vector<trace::EventId> moments(const render::FrameSpec& spec, const trace::Trace& trace);

/// Returns the last stored event of a step.
trace::EventId last_event(const trace::Trace& trace, std::size_t step);

}  // namespace lrb::run
