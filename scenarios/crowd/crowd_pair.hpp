#pragma once
/// Two bodies of a recorded crowd as a run of their own, which every command for runs of two bodies takes.

#include <string>

#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/broad_phase.hpp>

namespace lrb::crowd {

/// Returns the bodies with these names, separated by a comma: "gear 3,rock 5". Throws InputError.
BodyPair find_pair(const CrowdTrace& trace, const std::string& names);

/// Returns the scenario of two bodies at all complete steps of a trace, which lies at `path`. A is the one
/// with the lower number, as in the crowd's queries.
spec::Scenario scenario_of_pair(const CrowdTrace& trace, const BodyPair& pair, const std::string& path);

/// Throws InputError unless the scenario's run has the answers recorded in the trace.
void check_answers(const CrowdTrace& trace, const BodyPair& pair, const run::Recording& recording);

}  // namespace lrb::crowd
