#include "scenarios/run/thinned_events.hpp"

#include <algorithm>
#include <cstdint>

namespace lrb::run {
namespace {

/// What is kept first has the smallest number.
enum Rank : std::uint8_t { kChange, kMeeting, kOther, kGone };

/// Returns the rank of each event.
std::vector<std::uint8_t> ranks(const trace::Trace& trace) {
  std::vector<std::uint8_t> out(trace.events.size(), kOther);
  const bool by_face = trace.header.request.wrapper == WrapperMode::unregularised;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const trace::Event& e = trace.events[i];
    const bool changes = e.changes_wrapper() || e.kind == EventKind::pass_end;
    if (changes || e.kind == EventKind::step || e.kind == EventKind::result) out[i] = kChange;
    if (e.kind == EventKind::contact) out[i] = kMeeting;
    // The face that such a refinement takes away is that of its cause.
    if (e.changes_wrapper() && by_face && e.cause != kNull) out[e.cause] = kChange;
  }
  if (const trace::EventId first = first_contact(trace); first != kNull) out[first] = kChange;
  return out;
}

std::size_t changes_in(const std::vector<std::uint8_t>& rank, std::size_t first, std::size_t end) {
  return static_cast<std::size_t>(std::count(rank.begin() + static_cast<std::ptrdiff_t>(first),
                                             rank.begin() + static_cast<std::ptrdiff_t>(end), kChange));
}

/// The events of a step: [first, end).
struct StepEvents {
  std::size_t first, end;
};

std::vector<StepEvents> events_of_steps(const trace::Trace& trace) {
  std::vector<StepEvents> out;
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const std::size_t first = trace.steps[i].first_event;
    if (first < trace.events.size()) out.push_back({first, first + trace.events_of(i).size()});
  }
  return out;
}

/// Takes steps out, until what changes wrappers in the others fits. Keeps every n-th from the one of the
/// first contact on, and before it. Returns how many are left.
std::size_t drop_steps(const trace::Trace& trace, const std::vector<StepEvents>& steps, std::size_t most,
                       std::vector<std::uint8_t>& rank) {
  const trace::EventId first = first_contact(trace);
  std::size_t met = 0;
  while (first != kNull && steps[met].end <= first) ++met;
  for (std::size_t every = 1;; every *= 2) {
    std::size_t changes = 0, left = 0;
    for (std::size_t i = met % every; i < steps.size(); i += every, ++left)
      changes += changes_in(rank, steps[i].first, steps[i].end);
    if (changes > most && left > 1) continue;
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (i % every != met % every)
        std::fill(rank.begin() + static_cast<std::ptrdiff_t>(steps[i].first),
                  rank.begin() + static_cast<std::ptrdiff_t>(steps[i].end), kGone);
    return left;
  }
}

}  // namespace

trace::EventId first_contact(const trace::Trace& trace) {
  const auto at = std::find_if(trace.events.begin(), trace.events.end(),
                               [](const trace::Event& e) { return e.kind == EventKind::contact; });
  return at == trace.events.end() ? trace::EventId{kNull}
                                  : static_cast<trace::EventId>(at - trace.events.begin());
}

ThinnedEvents thin_events(const trace::Trace& trace, std::size_t most) {
  ThinnedEvents out;
  const std::vector<StepEvents> steps = events_of_steps(trace);
  out.steps = steps.size();
  std::vector<std::uint8_t> rank(trace.events.size(), kChange);
  if (trace.events.size() > most) {
    rank = ranks(trace);
    out.steps = drop_steps(trace, steps, most, rank);
  }
  std::vector<std::uint8_t> keep(rank.size());
  std::size_t room = most;
  for (const std::uint8_t wanted : {kChange, kMeeting, kOther}) {
    const auto there = static_cast<std::size_t>(std::count(rank.begin(), rank.end(), wanted));
    const std::size_t taken = std::min(room, there);
    // Replays need the first of what changes wrappers; of the rest, evenly spaced ones say most.
    const bool from_the_front = wanted == kChange;
    out.cut |= from_the_front && taken < there;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < rank.size(); ++i) {
      if (rank[i] != wanted) continue;
      keep[i] = from_the_front ? seen < taken : (seen + 1) * taken / there > seen * taken / there;
      ++seen;
    }
    room -= taken;
  }
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i] != 0) out.kept.push_back(static_cast<trace::EventId>(i));
  return out;
}

}  // namespace lrb::run
