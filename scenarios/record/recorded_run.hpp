#pragma once
/// Runs a scenario: asks every query and records every event. Draws nothing.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/pictures/marks.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::run {

/// Called with the progress of a long job: what it is doing, how much is done, how much there is.
using ProgressReport = std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)>;
/// A report that nobody reads.
inline const ProgressReport kSilent = [](const std::string&, std::uint64_t, std::uint64_t) {};

struct Recording {
  std::vector<bodies::LoadedBody> bodies;  ///< A and B, or A alone
  trace::Trace trace;
  std::vector<CollideResult> results;  ///< one for each step; none for one body
  /// A's tree and B's, if pairs of their nodes were recorded.
  std::vector<trace::TreeShape> trees;
  /// The pairs that another engine got wrong, for each step: first those that it reported, then those that it
  /// missed. Empty if none was recorded.
  std::vector<std::vector<WrongPair>> wrong;
  std::vector<std::string> notes;  ///< for people
};

/// Returns the trees of the bodies that a trace with pairs of nodes is about; none for other traces.
std::vector<trace::TreeShape> trees_of(const trace::Trace& trace,
                                       const std::vector<bodies::LoadedBody>& bodies);

bodies::LoadedBody make_body(const spec::BodySpec& spec);

/// Builds the bodies and runs the scenario. A construction is recorded while the builder works; a body that
/// comes with its regions is shown layer by layer.
Recording record(const spec::Scenario& scenario, const ProgressReport& progress);
/// Runs it with bodies that have been built.
Recording record(const spec::Scenario& scenario, std::vector<bodies::LoadedBody> bodies,
                 const ProgressReport& progress);

/// Returns one line for each expectation that was not met.
std::vector<std::string> mismatches(const spec::Scenario& scenario, const Recording& recording);

// Opens a run that was recorded and written.

/// Loads the bodies that were recorded: those named by `given`, or if it is empty those of these names beside
/// the trace.
std::vector<bodies::LoadedBody> find_bodies(const std::string& trace_path,
                                            const std::vector<std::string>& given,
                                            const std::vector<std::string>& names);

/// Returns the run whose trace has been read, with its bodies (see find_bodies()). Computes the contact
/// regions of each step anew, because a trace holds pairs but not where they meet. Throws InputError if the
/// trace cannot have come from these bodies.
Recording open_run(trace::Trace trace, const std::string& trace_path,
                   const std::vector<std::string>& bodies = {});

/// Returns the path of a run's trace, whether `run` is the run's folder or the trace itself. All commands
/// that take a recorded run take both. Throws InputError for a folder that has none.
std::string trace_of(const std::string& run);

/// Returns a run, given as trace_of() takes it, with a.lrb and b.lrb beside the trace.
Recording open_run(const std::string& run);

/// Two bodies as they stood at a step of a run.
struct OpenStep {
  std::vector<bodies::LoadedBody> bodies;
  trace::Step step;
};

/// Opens one step of a run, by its number; without a number the last. `run`: as trace_of() takes it.
/// Throws InputError if there is no such step, or only one body.
OpenStep open_step(const std::string& run, std::optional<std::uint32_t> number);

// Names of a run's files of frames.

/// Returns "frames/frame_0012", and the same with ".png".
std::string numbered_frame(std::size_t frame);
std::string frame_file(std::size_t frame);

/// Removes what an earlier run left: frames, montage and its caption, certificate of separation.
void remove_old_frames(const std::string& folder);

}  // namespace lrb::run
