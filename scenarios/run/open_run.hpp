#pragma once
/// Opens a run that was recorded and written.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/run/recorded_run.hpp"

namespace lrb::run {

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

}  // namespace lrb::run
