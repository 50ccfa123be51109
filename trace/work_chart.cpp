#include "trace/work_chart.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "trace/work_shares.hpp"

namespace lrb::trace {
namespace {

/// How the chart names the parts of work_shares(), in their order; an empty phase: that of the walk.
struct PartWords {
  std::string_view phase, outcome;
};
constexpr std::array<PartWords, 13> kPartWords = {{{"", "boxes of nodes"},
                                                   {"", "boxes and planes of faces"},
                                                   {"", "face tests: floats"},
                                                   {"", "face tests: shared corners"},
                                                   {"", "face tests: filter"},
                                                   {"", "face tests: expansions"},
                                                   {"", "face tests"},
                                                   {"", "wrappers refined"},
                                                   {"sorting", ""},
                                                   {"relation", ""},
                                                   {"separation", ""},
                                                   {"contact geometry", ""},
                                                   {"cache making", "pairs kept"}}};
constexpr std::size_t kWalks = 5;
constexpr std::array<std::string_view, kWalks> kWalkWords = {"walk of the bodies", "walk of levels",
                                                             "recursion", "cache making", "cached pairs"};

/// Follows which walk is going on.
class WalkFollower {
 public:
  explicit WalkFollower(const Trace& trace)
      : walk_(trace.header.request.recursion == Recursion::complete ? 0 : 2) {}

  void see(const Event& e) {
    if (e.kind != EventKind::begin) return;
    if (e.phase() == Phase::walk) walk_ = e.depth_a > 0 || e.depth_b > 0 ? 1 : 0;
    if (e.phase() == Phase::cache) walk_ = 3;
    if (e.phase() == Phase::cached || e.phase() == Phase::kept) walk_ = 4;
  }
  std::size_t walk() const { return walk_; }

 private:
  std::size_t walk_;
};

std::uint64_t operations_of(const Event& e) {
  if (e.kind != EventKind::node_pair) return work_count(e);
  return std::uint64_t{e.work().box_tests} +
         (e.node_end().step == NodeStep::leaves ? std::uint64_t{e.work().met} : 0);
}

}  // namespace

std::vector<WorkOutcome> outcomes_of_step(const Trace& trace, const WorkChart& chart, std::size_t step) {
  constexpr double kNanosecond = 1e-9;
  std::vector<WorkOutcome> out = chart.outcomes;
  for (WorkOutcome& o : out) o.events = o.operations = 0, o.seconds = 0;
  const EventId first = trace.steps[step].first_event;
  const auto end = first + static_cast<EventId>(trace.events_of(step).size());
  for (EventId i = first; i < end; ++i) {
    if (chart.of_event[i] == WorkChart::kNone) continue;
    WorkOutcome& o = out[chart.of_event[i]];
    ++o.events;
    o.operations += operations_of(trace.events[i]);
    if (!trace.wall_ns.empty())
      o.seconds += kNanosecond * static_cast<double>(trace.wall_ns[i] - trace.wall_ns[i - 1]);
  }
  return out;
}

WorkChart work_chart(const Trace& trace) {
  constexpr std::size_t kParts = kPartWords.size();
  constexpr double kNanosecond = 1e-9;
  // Step 1: one cell for each traversal and kind of work.
  std::vector<WorkOutcome> all(kWalks * kParts);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PartWords& words = kPartWords[i % kParts];
    all[i].phase = words.phase.empty() ? kWalkWords[i / kParts] : words.phase;
    all[i].outcome = words.outcome;
  }
  WorkChart out;
  out.of_event.assign(trace.events.size(), WorkChart::kNone);
  // Step 2: attribute each event to a cell. Work outside traversals uses the first row.
  WalkFollower follower(trace);
  for (EventId i = 0; i < trace.events.size(); ++i) {
    const Event& e = trace.events[i];
    follower.see(e);
    const std::optional<std::size_t> part = work_part(e);
    if (!part) continue;
    const bool of_walk = kPartWords[*part].phase.empty();
    const std::size_t at = (of_walk ? follower.walk() : 0) * kParts + *part;
    out.of_event[i] = static_cast<std::uint8_t>(at);
    ++all[at].events;
    all[at].operations += operations_of(e);
    if (!trace.wall_ns.empty())
      all[at].seconds += kNanosecond * static_cast<double>(trace.wall_ns[i] - trace.wall_ns[i - 1]);
  }
  // Step 3: drop empty cells, with traversals before the other phases.
  std::vector<std::size_t> order;
  for (const bool of_walk : {true, false})
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].events > 0 && kPartWords[i % kParts].phase.empty() == of_walk) order.push_back(i);
  // Step 4: renumber the events' cells accordingly.
  std::vector<std::uint8_t> place(all.size(), WorkChart::kNone);
  for (const std::size_t i : order) {
    place[i] = static_cast<std::uint8_t>(out.outcomes.size());
    out.outcomes.push_back(all[i]);
  }
  for (std::uint8_t& of : out.of_event)
    if (of != WorkChart::kNone) of = place[of];
  return out;
}

}  // namespace lrb::trace
