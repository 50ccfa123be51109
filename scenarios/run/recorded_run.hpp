#pragma once
/// Runs a scenario: asks every query and records every event. Draws nothing.

#include <functional>
#include <string>
#include <vector>

#include "scenarios/bodies/body.hpp"
#include "scenarios/run/pair_lines.hpp"
#include "scenarios/spec/scenario.hpp"
#include "trace/trace.hpp"
#include "trace/tree_shape.hpp"

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

}  // namespace lrb::run
