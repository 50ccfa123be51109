#pragma once
/// Writes and reads traces as files in Chrome's Trace Event Format, which Perfetto (ui.perfetto.dev) and
/// chrome://tracing open as it is. Everything needed to read a trace back exactly stands in the events'
/// `args` and in `metadata`, which comes last. trace/schema/trace.schema.json describes the format.
///
/// A trace of queries looks so there: one process with the threads "time steps", "face tests", "wrapper A",
/// "wrapper B" and "answer", and from EventLevel::nodes on "phases" and "tree walk".
/// - Every event is a slice (ph X): a step, named by what it found, spans its events, and so does a phase;
///   the others lie side by side. On the event clock, event i is [i, i + 1); on the wall clock (microseconds)
///   it reaches from the event before to this one, that is, over the time it took.
/// - Counters (ph C) hold numbers of the step so far: "wrapper" at each change (faces of A and B,
///   refinements), at every 16th event "work" (face tests, contacts) and, from EventLevel::nodes on,
///   "pending" (node pairs and face tests that are known and not done).
/// - Flows (ph s, f; their id is the number of the event that they lead to) lead from the refinement that
///   showed a face to each of its tests, and in the paper's recursions from the face test that caused a
///   refinement to that.
///
/// A construction has the threads "construction", "passes", named by what they made, "patches and caps" and
/// "hull", and the counter "hull" (faces, regions).

#include <span>
#include <string>
#include <string_view>

#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

class TreeShape;

/// A recorded body, for the figures that need more than its trace.
struct SummaryBody {
  const LrbRep* rep = nullptr;
  const TreeShape* walked =
      nullptr;  ///< the tree that was walked, ours or another engine's; null: no walk was recorded
};

/// Returns a run in numbers, as JSON: what `out/<name>/summary.json` holds and `--json` prints. Its members:
/// lrbscope, scenario, request, bodies, events, steps (index, relation, interiors_overlap, pairs,
/// fingerprint, the query's counters and the events' totals), totals, statistics and histograms, each with
/// its description; of a construction, from steps on, construction instead: patches, caps and regions, and
/// pass by pass. With the recorded bodies, in the order of the trace, also quality (of trees and LRB-reps)
/// and, where walks were recorded, walk_by_depth (each tree's nodes, what the surface area heuristic expects
/// and what was visited). Ends with a line break. On the event clock, the same run gives the same bytes.
std::string summary_json(const Trace& trace, std::span<const SummaryBody> bodies = {});

/// Writes a trace to a sink. Throws what the sink throws.
void write_trace(const Trace& trace, ByteSink& sink);
std::string trace_to_json(const Trace& trace);
/// Writes a trace to `path`, compressed if that ends in ".gz", whole or not at all. Throws EnvironmentError
/// (disk full, ...) or InputError (no such folder, ...).
void save_trace(const Trace& trace, const std::string& path);

struct ReadLimits {
  std::uint64_t max_bytes = std::uint64_t{1} << 30;  ///< largest length of the text, decompressed
};

/// Reads what write_trace() wrote. Throws InputError with a JSON pointer, "`name`: /metadata/version: ...",
/// or with line and column where it is not JSON. Any bytes are safe to give.
Trace trace_from_json(std::string_view text, const std::string& name);
/// Reads a trace from a file, plain or gzip, told apart by content. Throws InputError also if the file cannot
/// be read.
Trace load_trace(const std::string& path, const ReadLimits& limits = {});
/// Reads the text of such a file and does not interpret it.
std::string load_trace_text(const std::string& path, const ReadLimits& limits = {});

}  // namespace lrb::trace
