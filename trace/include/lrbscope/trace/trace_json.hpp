#pragma once
/// Writes and reads traces in Chrome's Trace Event Format, which Perfetto (ui.perfetto.dev) and
/// chrome://tracing open. The data needed to read a trace back exactly are in the events' `args` and in
/// `metadata`, which comes last. trace/schema/trace.schema.json describes the format.
///
/// A trace of queries is one process with the threads "time steps", "face tests", "wrapper A", "wrapper B"
/// and "answer" and, at EventLevel::nodes and above, "phases" and "tree walk".
/// - Every event is a slice (ph X). A step, named after its result, spans its events; so does a phase. The
///   others lie side by side. On the event clock, event i is [i, i + 1). On the wall clock (microseconds) it
///   lasts from the previous event to this one.
/// - Counters (ph C) hold numbers of the step so far: "wrapper" at each change (faces of A and B,
///   refinements), "work" at every 16th event (face tests, contacts) and, at EventLevel::nodes and above,
///   "pending" (node pairs and face tests that are known and not yet processed).
/// - Flows (ph s, f; their id is the number of the event that they lead to) lead from the refinement that
///   exposed a face to each of its tests, and in the paper's recursions from the face test that caused a
///   refinement to that refinement.
///
/// A construction has the threads "construction", "passes", named after their results, "patches and caps" and
/// "hull", and the counter "hull" (faces, regions).

#include <span>
#include <string>
#include <string_view>

#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

class TreeShape;

/// A recorded body, for the statistics that need more than its trace.
struct SummaryBody {
  const LrbRep* rep = nullptr;
  const TreeShape* walked =
      nullptr;  ///< the traversed tree, lrbscope's or another engine's; null: no traversal was recorded
};

/// Returns a run's statistics as JSON: the content of `out/<name>/summary.json` and of `--json`. Members:
/// lrbscope, scenario, request, bodies, events, steps (index, relation, interiors_overlap, pairs,
/// fingerprint, the query's counters and the events' totals), totals, statistics and histograms, each with
/// its description. For a construction, `construction` replaces steps and all that follow: patches, caps and
/// regions, by pass. With the recorded bodies, in the order of the trace, also quality (of trees and
/// LRB-reps) and, if traversals were recorded, walk_by_depth (each tree's nodes, the count expected by the
/// surface area heuristic and the visited ones). Ends with a line break. On the event clock, the same run
/// gives the same bytes.
std::string summary_json(const Trace& trace, std::span<const SummaryBody> bodies = {});

/// Writes a trace to a sink. Throws whatever the sink throws.
void write_trace(const Trace& trace, ByteSink& sink);
std::string trace_to_json(const Trace& trace);
/// Writes a trace to `path`, gzip-compressed if the name ends in ".gz". The file is written completely or not
/// at all. Throws EnvironmentError (disk full, ...) or InputError (no such folder, ...).
void save_trace(const Trace& trace, const std::string& path);
/// Saves what `write` writes in the same way.
void save_trace(const std::function<void(ByteSink&)>& write, const std::string& path);

struct ReadLimits {
  std::uint64_t max_bytes = std::uint64_t{1} << 30;  ///< maximum length of the text, decompressed
};

/// Parses the output of write_trace(). Throws InputError with a JSON pointer, "`name`: /metadata/version:
/// ...", or with line and column if the text is not JSON. Safe for arbitrary bytes.
Trace trace_from_json(std::string_view text, const std::string& name);
/// Reads a trace from a plain or gzip file, distinguished by content. Throws InputError also if the file
/// cannot be read.
Trace load_trace(const std::string& path, const ReadLimits& limits = {});
/// Reads and decompresses the text of such a file without parsing it.
std::string load_trace_text(const std::string& path, const ReadLimits& limits = {});

}  // namespace lrb::trace
