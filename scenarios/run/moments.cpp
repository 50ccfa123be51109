#include "scenarios/run/moments.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "scenarios/run/frame_files.hpp"
#include "trace/passes.hpp"

namespace lrb::run {
namespace {

using trace::EventId;

/// Returns every n-th of the list, and its last.
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

/// Returns the beginning of each step and the events in it that change a wrapper.
std::vector<EventId> wrapper_changes(const trace::Trace& trace) {
  std::vector<EventId> out;
  for (EventId e = 0; e < trace.events.size(); ++e) {
    if (trace.events[e].kind == EventKind::step || trace.events[e].changes_wrapper()) out.push_back(e);
  }
  return out;
}

/// Returns the event at which the body stands bare, and the last one of each pass that made regions.
std::vector<EventId> pass_ends(const trace::Trace& trace) {
  if (!trace.header.construction)
    throw InputError("frames after passes are for constructions: take step, refinement or event");
  std::vector<EventId> out = {0};
  for (const trace::PassSummary& p : trace::passes_of(trace))
    if (p.regions > 0) out.push_back(p.last);
  return out;
}

std::vector<EventId> listed(const render::FrameSpec& spec, const trace::Trace& trace) {
  std::vector<EventId> out = spec.events;
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  if (!out.empty() && out.back() >= trace.events.size())
    throw InputError("frames: event " + std::to_string(out.back()) +
                     " was asked for, but the trace ends with event " +
                     std::to_string(trace.events.size() - 1));
  return out;
}

}  // namespace

EventId last_event(const trace::Trace& trace, std::size_t step) {
  const std::size_t end =
      step + 1 < trace.steps.size() ? trace.steps[step + 1].first_event : trace.events.size();
  return static_cast<EventId>(end - 1);
}

std::vector<EventId> moments(const render::FrameSpec& spec, const trace::Trace& trace) {
  if (trace.events.empty()) return {};
  std::vector<EventId> all;
  switch (spec.at) {
    case render::FrameSpec::At::none:
      return {};
    case render::FrameSpec::At::step:
      all = every(step_ends(trace), spec.every);
      break;
    case render::FrameSpec::At::refinement:
      all = every(wrapper_changes(trace), spec.every);
      break;
    case render::FrameSpec::At::pass:
      all = every(pass_ends(trace), spec.every);
      break;
    case render::FrameSpec::At::every: {
      std::vector<EventId> events(trace.events.size());
      for (EventId e = 0; e < events.size(); ++e) events[e] = e;
      all = every(events, spec.every);
      break;
    }
    case render::FrameSpec::At::events:
      all = listed(spec, trace);
      break;
  }
  std::vector<EventId> out;
  for (const std::size_t i : evenly(all.size(), spec.most)) out.push_back(all[i]);
  return out;
}

}  // namespace lrb::run
