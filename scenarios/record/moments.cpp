#include "scenarios/record/moments.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/pictures/panel.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/counters.hpp>

namespace lrb::record {
namespace {

using trace::EventId;

/// Returns every n-th element of the list, and its last.
std::vector<EventId> every(const std::vector<EventId>& all, std::uint32_t n) {
  std::vector<EventId> out;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i % n == 0 || i + 1 == all.size()) out.push_back(all[i]);
  return out;
}

std::vector<EventId> step_ends(const trace::Trace& trace) {
  std::vector<EventId> out;
  for (std::size_t step = 0; step < trace.steps.size(); ++step)
    if (trace.steps[step].first_event < trace.events.size()) out.push_back(last_event(trace, step));
  return out;
}

/// Returns the first event of each step and the events in it that change a wrapper.
std::vector<EventId> wrapper_changes(const trace::Trace& trace) {
  std::vector<EventId> out;
  for (EventId e = 0; e < trace.events.size(); ++e) {
    if (trace.events[e].kind == EventKind::step || trace.events[e].changes_wrapper()) out.push_back(e);
  }
  return out;
}

/// Returns the event at which the wrapper is the body itself, and the last one of each pass that made
/// regions.
std::vector<EventId> pass_ends(const trace::Trace& trace) {
  if (!trace.header.construction)
    throw InputError("frames \"pass\": expected a construction; use step, refinement or event");
  std::vector<EventId> out = {0};
  for (const trace::PassSummary& p : trace::passes_of(trace))
    if (p.regions > 0) out.push_back(p.last);
  return out;
}

std::vector<EventId> listed(const pictures::FrameSpec& spec, const trace::Trace& trace) {
  std::vector<EventId> out = spec.events;
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  if (!out.empty() && out.back() >= trace.events.size())
    throw InputError("frames: event " + std::to_string(out.back()) + ": the trace ends with event " +
                     std::to_string(trace.events.size() - 1));
  return out;
}

}  // namespace

std::size_t nearest_by_ratio(std::span<const double> sizes, double size) {
  const auto deviation = [&](double s) { return std::abs(std::log(std::max(s, 1.0) / size)); };
  return static_cast<std::size_t>(
      std::min_element(sizes.begin(), sizes.end(),
                       [&](double x, double y) { return deviation(x) < deviation(y); }) -
      sizes.begin());
}

std::vector<std::size_t> by_ratio(std::span<const double> sizes, std::size_t count) {
  const double first = std::max(sizes.front(), 1.0), last = std::max(sizes.back(), 1.0);
  if (count == 1) return {nearest_by_ratio(sizes, std::sqrt(first * last))};
  std::vector<std::size_t> out = {0};
  for (std::size_t i = 1; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    out.push_back(nearest_by_ratio(sizes, first * std::pow(last / first, share)));
  }
  return out;
}

EventId last_event(const trace::Trace& trace, std::size_t step) {
  const std::size_t end =
      step + 1 < trace.steps.size() ? trace.steps[step + 1].first_event : trace.events.size();
  return static_cast<EventId>(end - 1);
}

std::vector<EventId> moments(const pictures::FrameSpec& spec, const trace::Trace& trace) {
  if (trace.events.empty()) return {};
  std::vector<EventId> all;
  switch (spec.at) {
    case pictures::FrameSpec::At::none:
      return {};
    case pictures::FrameSpec::At::step:
      all = every(step_ends(trace), spec.every);
      break;
    case pictures::FrameSpec::At::refinement:
      all = every(wrapper_changes(trace), spec.every);
      break;
    case pictures::FrameSpec::At::pass:
      all = every(pass_ends(trace), spec.every);
      break;
    case pictures::FrameSpec::At::every: {
      std::vector<EventId> events(trace.events.size());
      for (EventId e = 0; e < events.size(); ++e) events[e] = e;
      all = every(events, spec.every);
      break;
    }
    case pictures::FrameSpec::At::events:
      all = listed(spec, trace);
      break;
  }
  std::vector<EventId> out;
  for (const std::size_t i : pictures::evenly(all.size(), spec.most)) out.push_back(all[i]);
  return out;
}

namespace {

/// Events of lower rank are kept first.
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
    // The face removed by such a refinement is named by its cause.
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

/// Drops steps until the wrapper changes in the others fit. Keeps every n-th step, counted forward and
/// backward from the first contact. Returns the number of steps left.
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
    // Replays need the first wrapper changes; of other events, evenly spaced ones are the most informative.
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

}  // namespace lrb::record
