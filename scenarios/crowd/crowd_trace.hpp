#pragma once
/// Reads a crowd's trace back: enough of it to draw its steps again.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/crowd/crowd_run.hpp"
#include <lrbscope/trace/json_write.hpp>

namespace lrb::crowd {

/// Writes the run in Chrome's Trace Event Format, as trace/include/lrbscope/trace/trace_json.hpp does for two
/// bodies. On the event clock, a query is as long as its own trace would be (CrowdQuery::events()), queries
/// follow each other, and each body has a track that shows its queries; the same for any number of threads.
/// On the wall clock, in microseconds, each thread has a track. A track for steps and one for the broad phase
/// stand above; counters are those of the step. The metadata hold the bodies' poses (by step and body, each
/// as in pose files) for the first steps, at most as many poses as slices of queries are kept. That is all
/// that replay_crowd() needs.
void write_crowd_trace(const spec::Crowd& crowd, const CrowdRun& run, trace::ByteSink& sink);

inline constexpr std::string_view kCrowdFormat = "lrbscope crowd";
inline constexpr std::uint32_t kCrowdVersion = 2;  ///< of the format; version 1 had no poses and cannot be
                                                   ///< replayed

/// Writes "kinds": what their bodies are, and how many there are.
void write_kinds(trace::JsonWriter& w, const spec::Crowd& crowd, const CrowdRun& run);

/// Returns the run in numbers, without times: the same for any number of threads.
std::string crowd_summary(const spec::Crowd& crowd, const CrowdRun& run);

/// Returns the time it took: nanoseconds in all, and for each step.
std::string crowd_timing(const CrowdRun& run);

/// Returns the number of queries of a step that gave this answer.
std::size_t count(const CrowdStep& step, Relation relation);
/// Returns the number of bodies of a step that meet another one.
std::size_t bodies_in_contact(const CrowdStep& step, std::size_t bodies);
/// Adds up everything that the queries of a step counted (except the list by level).
Counters sum(const CrowdStep& step);

struct CrowdTrace {
  /// The answer to one query.
  struct Answer {
    BodyPair bodies{0, 0};
    Relation relation = Relation::separate;
    std::uint64_t pairs = 0, fingerprint = 0;
    friend auto operator<=>(const Answer&, const Answer&) = default;
  };
  std::string file;         ///< for messages
  spec::Crowd crowd;        ///< as far as pictures need it; its steps are those that the trace holds whole
  std::uint32_t steps = 0;  ///< number of steps that were run
  std::vector<trace::BodyInfo> bodies;       ///< one for each kind
  std::vector<std::vector<Pose>> poses;      ///< by whole step and body
  std::vector<std::vector<Answer>> answers;  ///< by whole step, ascending by bodies
};

/// Returns true if a trace says that it is one of a crowd.
bool is_crowd_trace(std::string_view text);

/// Reads what write_crowd_trace() wrote. Throws InputError as trace_from_json() does, and for a trace that
/// holds no whole step; any bytes are safe.
CrowdTrace read_crowd_trace(std::string_view text, const std::string& file);

/// Asks the queries of the whole steps again, for what the trace does not hold (regions that were opened,
/// pairs of faces, contacts), and checks their answers against the trace. `kinds` are the bodies that were
/// recorded; throws InputError if they are others, or if answers differ.
CrowdRun replay_crowd(const CrowdTrace& trace, std::vector<bodies::LoadedBody> kinds, std::uint32_t threads,
                      const run::ProgressReport& progress);

}  // namespace lrb::crowd
