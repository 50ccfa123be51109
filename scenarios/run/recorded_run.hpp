#pragma once
/// A scenario's run: every query asked, every event written down. Nothing is drawn here.

#include <functional>
#include <string>
#include <vector>

#include "scenarios/bodies/body.hpp"
#include "scenarios/spec/scenario.hpp"
#include "trace/trace.hpp"

namespace lrb::run {

/// How far a long job has come: what it is doing, how much is done, how much there is.
using ProgressReport = std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)>;

struct Recording {
  std::vector<bodies::LoadedBody> bodies;  ///< A and B, or A alone
  trace::Trace trace;
  std::vector<CollideResult> results;      ///< one a step; none for one body
  std::vector<trace::EventId> milestones;  ///< construction: the last event of each pass
  std::vector<std::string> notes;          ///< for people
};

bodies::LoadedBody make_body(const spec::BodySpec& spec);

/// Builds the bodies and plays the scenario.
Recording record(const spec::Scenario& scenario, const ProgressReport& progress);
/// Plays it with bodies that are there already.
Recording record(const spec::Scenario& scenario, std::vector<bodies::LoadedBody> bodies,
                 const ProgressReport& progress);

/// One line for each expectation that was not met.
std::vector<std::string> mismatches(const spec::Scenario& scenario, const Recording& recording);

}  // namespace lrb::run
