#pragma once
/// Runs a scenario: performs all queries and records all events. Draws nothing.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/record/engine_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::record {

/// Called with the progress of a long job: the current activity, the amount done, the total.
using ProgressReport = std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)>;
/// A report that is discarded.
inline const ProgressReport kSilent = [](const std::string&, std::uint64_t, std::uint64_t) {};

struct Recording {
  std::vector<bodies::LoadedBody> bodies;  ///< A and B, or A alone
  trace::Trace trace;
  std::vector<CollideResult> results;  ///< one for each step; empty for one body
  /// The trees of A and B, if pairs of their nodes were recorded.
  std::vector<trace::TreeShape> trees;
  std::vector<WrongAnswer> wrong;  ///< of another engine, by step; empty if only lrbscope was recorded
  std::vector<std::string> notes;  ///< notes as text
};

/// Returns the trees of the bodies of a trace with node pairs; empty for other traces.
std::vector<trace::TreeShape> trees_of(const trace::Trace& trace,
                                       const std::vector<bodies::LoadedBody>& bodies);

bodies::LoadedBody make_body(const spec::BodySpec& spec);

/// Builds the bodies and runs the scenario. A construction is recorded during the build; a body loaded with
/// its regions is shown layer by layer.
Recording record(const spec::Scenario& scenario, const ProgressReport& progress);
/// Runs it with existing bodies.
Recording record(const spec::Scenario& scenario, std::vector<bodies::LoadedBody> bodies,
                 const ProgressReport& progress);

/// Returns one line for each expectation that was not met.
std::vector<std::string> mismatches(const spec::Scenario& scenario, const Recording& recording);

// Opens a recorded and written run.

/// Returns the run of a trace, with its bodies: those in `bodies`, or if it is empty a.lrb and b.lrb next to
/// the trace. Recomputes the contact regions of each step, because a trace contains pairs but not their
/// intersections. Throws InputError if the trace cannot be a recording of these bodies.
Recording open_run(trace::Trace trace, const std::string& trace_path,
                   const std::vector<std::string>& bodies = {});

/// Returns the path of a run's trace; `run` is the run's folder or the trace itself. All commands that take a
/// recorded run accept both. Throws InputError for a folder without a trace.
std::string trace_of(const std::string& run);

/// Returns a run, given as in trace_of(), with a.lrb and b.lrb next to the trace.
Recording open_run(const std::string& run);

/// Two bodies in their state at a step of a run.
struct OpenStep {
  std::vector<bodies::LoadedBody> bodies;
  trace::Step step;
};

/// Opens one step of a run by number, or the last without a number. `run`: as in trace_of(). Throws
/// InputError if the step does not exist, or the run has one body.
OpenStep open_step(const std::string& run, std::optional<std::uint32_t> number);

// Names of a run's files of frames.

/// Returns "frames/frame_0012", and the same with ".png".
std::string numbered_frame(std::size_t frame);
std::string frame_file(std::size_t frame);

/// Removes the output of an earlier run: frames, montage and its caption, certificate of separation.
void remove_old_frames(const std::string& folder);

}  // namespace lrb::record
