#pragma once
/// Traces as files: Chrome's Trace Event Format, which opens in Perfetto (ui.perfetto.dev) and
/// chrome://tracing as it is. Everything needed to read a trace back exactly is in the events' `args` and in
/// `metadata`, which comes last. trace/schema/trace.schema.json describes the format.
///
/// How a trace looks there: one process; threads "time steps", "face tests", "wrapper A", "wrapper B",
/// "answer".
/// - Every event is a slice (ph X): a step spans its events, the others lie side by side. Event clock: event
/// i is
///   [i, i + 1). Wall clock (microseconds): from the event before to this one, that is, the time it took.
/// - Counters (ph C), of the step so far: "wrapper" at each change (faces of A and B, refinements), "work"
/// every 16
///   events (face tests, contacts).
/// - Flows (ph s, t, f; the refinement's number is their id): from the face test that caused a refinement,
/// through
///   it, to the first face test of a face that it brought in.

#include <string>
#include <string_view>

#include "trace/json_out.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

/// Writes to a sink. Throws what the sink throws.
void write_trace(const Trace& trace, ByteSink& sink);
std::string trace_to_json(const Trace& trace);
/// Writes `path`, compressed if it ends in ".gz", whole or not at all. Throws
/// EnvironmentError (disk full, ...) or InputError (no such folder, ...).
void save_trace(const Trace& trace, const std::string& path);

struct ReadLimits {
  std::uint64_t max_bytes = std::uint64_t{1} << 30;  ///< of the text, decompressed
};

/// Reads what write_trace() wrote. Throws InputError: "`name`: /metadata/version: ..." with a JSON pointer,
/// or with line and column where it is not JSON; any bytes are safe.
Trace trace_from_json(std::string_view text, const std::string& name);
/// Plain or gzip, told apart by content. Throws InputError also if the file cannot be read.
Trace load_trace(const std::string& path, const ReadLimits& limits = {});
/// The same, but for reading it as a trace.
std::string load_trace_text(const std::string& path, const ReadLimits& limits = {});

}  // namespace lrb::trace
