#include "scenarios/paper/close_up.hpp"

#include <algorithm>
#include <map>

#include "engine/core/error.hpp"
#include "engine/query/collide_impl.hpp"
#include "engine/query/walk/query_context.hpp"
#include "trace/recorder.hpp"

namespace lrb::paper {
namespace {

/// Returns true if the records of one collision, in the order of its steps, agree with what it took now.
bool same_counts(std::span<const ContactStep> records, const CloseUp& found, const std::string& object) {
  std::size_t next = 0;
  for (const ContactStep& r : records) {
    if (r.object != object || r.collision != found.collision) continue;
    if (next >= found.steps.size()) return false;
    const ContactStep& now = found.steps[next++];
    if (r.step != now.step || r.counts[kPaper].comparisons != now.counts[kPaper].comparisons) return false;
  }
  return next == found.steps.size();
}

}  // namespace

std::array<std::uint32_t, 2> easiest_and_hardest(std::span<const ContactStep> steps,
                                                 const std::string& object) {
  std::map<std::uint32_t, std::uint64_t> comparisons;
  for (const ContactStep& s : steps)
    if (s.object == object) comparisons[s.collision] += s.counts[kPaper].comparisons;
  if (comparisons.empty())
    throw InputError("no collision with " + object + " was recorded: there is nothing to look at closely");
  const auto less = [](const auto& p, const auto& q) { return p.second < q.second; };
  return {std::min_element(comparisons.begin(), comparisons.end(), less)->first,
          std::max_element(comparisons.begin(), comparisons.end(), less)->first};
}

CloseUp close_up(const PaperPair& pair, std::uint32_t collision, const PaperProtocol& protocol,
                 std::span<const ContactStep> records) {
  QueryContext context;
  CloseUp out;
  out.collision = collision;
  out.steps = run_collision(pair.a.rep, pair.x.rep, pair.x.name, collision, protocol, context);
  if (!same_counts(records, out, pair.x.name))
    throw InputError("collision " + std::to_string(collision) + " of " + pair.a.name + " with " +
                     pair.x.name +
                     " is not what the records say: they were made by another experiment; "
                     "give the one they were made by, with the same options");
  trace::RecorderSettings settings;
  settings.request.recursion = kRecursions[kPaper];
  trace::Recorder recorder(pair.a.rep, pair.x.rep, settings);
  for (const ContactStep& s : out.steps) {
    recorder.begin_step(s.step, s.pose_a, s.pose_x);
    recorder.end_step(
        collide(pair.a.rep, s.pose_a, pair.x.rep, s.pose_x, settings.request, context, recorder));
    out.comparisons += s.counts[kPaper].comparisons;
  }
  out.trace = recorder.take();
  return out;
}

}  // namespace lrb::paper
