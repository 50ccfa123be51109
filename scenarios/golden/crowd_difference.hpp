#pragma once
/// Differences of two runs of a crowd, by their traces.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/golden/golden_run.hpp"
#include <lrbscope/trace/divergence.hpp>

namespace lrb::golden {

/// Returns the number of queries in all steps.
std::size_t query_count(const crowd::CrowdTrace& trace);

/// Returns all differences of the queries, as find_effects(). If the crowds have different bodies, this is
/// the only difference.
std::vector<Effect> crowd_effects(const crowd::CrowdTrace& expected, const crowd::CrowdTrace& found);

/// Returns the first difference: bodies and request, then per step poses, answers and counters. Returns
/// nullopt if the runs are equal.
std::optional<trace::Divergence> first_divergence(const crowd::CrowdTrace& expected,
                                                  const crowd::CrowdTrace& found);

/// Return a line about changed kinds or numbers of bodies, and about the first pose that differs. Empty: they
/// are equal.
std::string kinds_cause(const crowd::CrowdTrace& expected, const crowd::CrowdTrace& found);
std::string crowd_pose_cause(const crowd::CrowdTrace& expected, const crowd::CrowdTrace& found);

}  // namespace lrb::golden
