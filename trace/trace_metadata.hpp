#pragma once

#include "trace/json_out.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

/// Writes a trace's `metadata`: all that its events do not say.
void write_metadata(const Trace& trace, JsonOut& out);

}  // namespace lrb::trace
