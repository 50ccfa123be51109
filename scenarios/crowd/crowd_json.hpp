#pragma once

#include <string>
#include <string_view>

#include "scenarios/crowd/crowd_run.hpp"
#include "trace/json_out.hpp"

namespace lrb::crowd {

/// The run in Chrome's Trace Event Format, as trace/trace_json.hpp has it for two bodies. Event clock: a
/// query is as long as its own trace would be (CrowdQuery::events()), queries follow each other, and there is
/// a track a body, on which each of its queries is shown; the same for any number of threads. Wall clock: a
/// track a thread, microseconds. A track for steps and one for the broad phase stand above; counters are of
/// the step. The metadata hold the bodies' poses (by step and body, each as in pose files), for as many steps
/// as make no more poses than slices of queries are kept: all that replay_crowd() needs.
void write_crowd_trace(const spec::Crowd& crowd, const CrowdRun& run, trace::ByteSink& sink);

inline constexpr std::string_view kCrowdFormat = "lrbscope crowd";
inline constexpr std::uint32_t kCrowdVersion = 2;  ///< of the format; 1 had no poses and cannot be replayed

/// "kinds": what their bodies are, and how many there are.
void write_kinds(trace::JsonWriter& w, const spec::Crowd& crowd, const CrowdRun& run);

/// The run in numbers, without times: the same for any number of threads.
std::string crowd_summary(const spec::Crowd& crowd, const CrowdRun& run);

/// How long it took: nanoseconds in all, and of each step.
std::string crowd_timing(const CrowdRun& run);

/// How many queries of a step answered so.
std::size_t count(const CrowdStep& step, Relation relation);
/// Bodies of a step that meet another.
std::size_t bodies_in_contact(const CrowdStep& step, std::size_t bodies);
/// Everything that the queries of a step counted (not the list by level).
Counters sum(const CrowdStep& step);

}  // namespace lrb::crowd
