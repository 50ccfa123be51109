#pragma once
/// Writes and reads a crowd's trace, which has all data needed to draw its steps again.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "scenarios/crowd/crowd_run.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/broad_phase.hpp>
#include <lrbscope/trace/json_write.hpp>

namespace lrb::crowd {

/// Writes the run in Chrome's Trace Event Format, as trace/include/lrbscope/trace/trace_json.hpp does for two
/// bodies. On the event clock, a query is as long as its own trace would be (CrowdQuery::events()), queries
/// follow each other, and each body has a track that shows its queries; the trace does not depend on the
/// number of threads. On the wall clock, in microseconds, each thread has a track. A track for steps and one
/// for the broad phase come first; counters are per step. The metadata contain the bodies' poses (by step and
/// body, each as in pose files) for the first steps; the number of poses is limited as for the query
/// slices kept. This suffices for replay_crowd().
void write_crowd_trace(const spec::Crowd& crowd, const CrowdRun& run, trace::ByteSink& sink);

inline constexpr std::string_view kCrowdFormat = "lrbscope crowd";
inline constexpr std::uint32_t kCrowdVersion = 2;  ///< of the format; version 1 had no poses and cannot be
                                                   ///< replayed

/// Writes "kinds": the bodies of each, and their number.
void write_kinds(trace::JsonWriter& w, const spec::Crowd& crowd, const CrowdRun& run);

/// Returns the run's key figures, without times. They do not depend on the number of threads.
std::string crowd_summary(const spec::Crowd& crowd, const CrowdRun& run);

/// Returns the run's duration: nanoseconds in total, and for each step.
std::string crowd_timing(const CrowdRun& run);

/// Returns the number of queries of a step with this relation.
std::size_t count(const CrowdStep& step, Relation relation);
/// Returns the number of bodies of a step that intersect another one.
std::size_t bodies_in_contact(const CrowdStep& step, std::size_t bodies);
/// Sums the counters of a step's queries (except the list by level).
Counters sum(const CrowdStep& step);

/// The counters that the trace has of each query.
struct QueryCounter {
  const char* name;
  std::uint64_t Counters::*member;
};
inline constexpr std::array kQueryCounters = {QueryCounter{"face tests", &Counters::face_tests},
                                              QueryCounter{"refinements", &Counters::refinements},
                                              QueryCounter{"regions opened", &Counters::regions_opened},
                                              QueryCounter{"node pairs", &Counters::node_pairs},
                                              QueryCounter{"box tests", &Counters::box_tests},
                                              QueryCounter{"exact fallbacks", &Counters::exact_fallbacks}};

struct CrowdTrace {
  /// The answer to one query, its measures and its work. Only the answer is compared.
  struct Answer {
    BodyPair bodies{0, 0};
    Relation relation = Relation::separate;
    std::uint64_t pairs = 0, fingerprint = 0;
    std::optional<std::array<double, 2>> distance = {}, depth = {};  ///< bounds
    std::optional<ClashKind> kind = {};
    std::optional<std::uint64_t> near_pairs = {};
    std::uint64_t contact_regions = 0;
    std::array<std::uint64_t, kQueryCounters.size()> work{};

    auto answer() const { return std::tie(bodies, relation, pairs, fingerprint); }
    friend auto operator<=>(const Answer& x, const Answer& y) { return x.answer() <=> y.answer(); }
    friend bool operator==(const Answer& x, const Answer& y) { return x.answer() == y.answer(); }
  };
  std::string file;         ///< for error messages
  std::string lrbscope;     ///< the version that recorded it
  spec::Crowd crowd;        ///< the parts needed for pictures; its steps are the complete steps of the trace
  std::uint32_t steps = 0;  ///< number of steps that were run
  std::vector<trace::BodyInfo> bodies;       ///< one for each kind
  std::vector<std::vector<Pose>> poses;      ///< by whole step and body
  std::vector<std::vector<Answer>> answers;  ///< by whole step, ascending by bodies
};

/// Returns true if a trace is marked as one of a crowd.
bool is_crowd_trace(std::string_view text);

/// Reads a file written by write_crowd_trace(). Throws InputError as trace_from_json() does, and for a trace
/// without a complete step. Safe for arbitrary input.
CrowdTrace read_crowd_trace(std::string_view text, const std::string& file);

/// Repeats the queries of the complete steps to compute data that the trace does not contain (refined
/// regions, pairs of faces, contacts), and checks their answers against the trace. `kinds` are the recorded
/// bodies. Throws InputError if they are others, or if answers differ.
CrowdRun replay_crowd(const CrowdTrace& trace, std::vector<bodies::LoadedBody> kinds, std::uint32_t threads,
                      const run::ProgressReport& progress);

// Two bodies of a recorded crowd as a run of their own, which every command for runs of two bodies takes.

/// Returns the bodies with these names, separated by a comma: "gear 3,rock 5". Throws InputError.
BodyPair find_pair(const CrowdTrace& trace, const std::string& names);

/// Returns the scenario of two bodies at all complete steps of a trace, which lies at `path`. A is the one
/// with the lower number, as in the crowd's queries.
spec::Scenario scenario_of_pair(const CrowdTrace& trace, const BodyPair& pair, const std::string& path);

/// Throws InputError unless the scenario's run has the answers recorded in the trace.
void check_answers(const CrowdTrace& trace, const BodyPair& pair, const run::Recording& recording);

}  // namespace lrb::crowd
