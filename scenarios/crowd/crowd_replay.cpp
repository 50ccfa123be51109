#include "scenarios/crowd/crowd_replay.hpp"

#include "engine/core/error.hpp"
#include "trace/cursor.hpp"
#include "trace/hex.hpp"

namespace lrb::crowd {
namespace {

std::string words(const CrowdTrace::Answer* a) {
  return a == nullptr ? "no query"
                      : std::string(to_string(a->relation)) + " in " + std::to_string(a->pairs) +
                            " pairs, fingerprint " + trace::to_hex(a->fingerprint);
}

/// Throws at the first answer that differs.
void compare(const CrowdTrace& trace, const CrowdRun& run, std::size_t step) {
  std::vector<CrowdTrace::Answer> found;
  for (const CrowdQuery& q : run.steps[step].queries)
    found.push_back({q.bodies, q.result.relation, q.result.pair_count, q.result.fingerprint});
  const std::vector<CrowdTrace::Answer>& recorded = trace.answers[step];
  for (std::size_t i = 0; i < std::max(found.size(), recorded.size()); ++i) {
    const CrowdTrace::Answer *x = i < recorded.size() ? &recorded[i] : nullptr,
                             *y = i < found.size() ? &found[i] : nullptr;
    if (x != nullptr && y != nullptr && *x == *y) continue;
    if (x != nullptr && y != nullptr && x->bodies != y->bodies) (x->bodies < y->bodies ? y : x) = nullptr;
    const BodyPair bodies = x != nullptr ? x->bodies : y->bodies;
    throw InputError(trace.file + ": step " + std::to_string(step) + ", " + run.names[bodies.i] + " and " +
                     run.names[bodies.j] + ": recorded was " + words(x) + ", but these bodies give " +
                     words(y) + "; the trace is damaged: record it again");
  }
}

}  // namespace

CrowdRun replay_crowd(const CrowdTrace& trace, std::vector<bodies::LoadedBody> kinds, std::uint32_t threads,
                      const run::ProgressReport& progress) {
  if (kinds.size() != trace.bodies.size())
    throw InputError(trace.file + ": has " + std::to_string(trace.bodies.size()) +
                     " kinds of bodies, given are " + std::to_string(kinds.size()));
  for (std::size_t k = 0; k < kinds.size(); ++k)
    trace::require_same_body(trace.bodies[k], kinds[k].rep, trace.crowd.kinds[k].name);
  CrowdRun run =
      play_crowd(trace.crowd, std::move(kinds), CrowdMotion(trace.crowd, trace.poses), threads, progress);
  for (std::size_t step = 0; step < run.steps.size(); ++step) compare(trace, run, step);
  if (trace.crowd.steps < trace.steps)
    run.notes.push_back("the trace holds the first " + std::to_string(trace.crowd.steps) + " of " +
                        std::to_string(trace.steps) + " steps (trace.max_events): these are drawn");
  return run;
}

}  // namespace lrb::crowd
