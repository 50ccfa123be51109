#pragma once
/// The result of a crowd's run: its pairs of bodies by cost, its numbers, and two of its bodies as a run of
/// their own, which every command for runs of two bodies takes.

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/crowd/crowd_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/broad_phase.hpp>

namespace lrb::crowd {

/// The queries of two bodies over all steps.
struct PairHistory {
  BodyPair bodies{0, 0};
  std::uint64_t face_tests = 0;        ///< sum over all steps
  std::uint32_t steps = 0, first = 0;  ///< the number of steps at which they intersect, and the first one
  std::uint64_t most_pairs = 0;        ///< of faces at a step
  std::uint32_t at = 0;                ///< the last step with so many
};

/// Returns the pairs of bodies that were queried, those with most face tests first.
std::vector<PairHistory> pair_histories(const CrowdRun& run);

/// Returns a table of the first `most` pairs, a line for each.
std::string pair_table(const CrowdRun& run, std::size_t most);

/// Returns the run's key figures as JSON, without times. They do not depend on the number of threads.
std::string crowd_summary(const spec::Crowd& crowd, const CrowdRun& run);

/// Returns one line of text with the duration of a step.
std::string crowd_speed(const CrowdRun& run);

/// Returns the bodies with these names, separated by a comma: "gear 3,rock 5". Throws InputError.
BodyPair find_pair(const spec::Crowd& crowd, const std::string& names);

/// Returns the scenario of two bodies at all steps of a crowd. A is the one with the lower number, as in the
/// crowd's queries.
spec::Scenario scenario_of_pair(const spec::Crowd& crowd, const CrowdMotion& motion, const BodyPair& pair);

}  // namespace lrb::crowd
