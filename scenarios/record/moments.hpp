#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

/// Returns the events after which pictures are taken, ascending, at most spec.most of them. Throws InputError
/// for events that the trace does not have, and for passes of what is no construction.
std::vector<trace::EventId> moments(const render::FrameSpec& spec, const trace::Trace& trace);

/// Returns the last stored event of a step.
trace::EventId last_event(const trace::Trace& trace, std::size_t step);

// Chooses the events that a page holds, where a trace has more than a page should.

struct ThinnedEvents {
  std::vector<trace::EventId> kept;  ///< ascending
  /// Number of steps kept. For each of them `kept` has all events that change a wrapper, so that it can be
  /// replayed; the other steps have no events.
  std::size_t steps = 0;
  /// The one step that is left has more such events than there is room for: the first of them are kept, and
  /// nothing else.
  bool cut = false;

  bool all(const trace::Trace& trace) const { return kept.size() == trace.events.size(); }
};

/// Keeps at most `most` events: all if they fit; else what changes wrappers, or that of some evenly chosen
/// steps, then contacts, then evenly chosen ones of the rest. The first contact is kept, too.
ThinnedEvents thin_events(const trace::Trace& trace, std::size_t most);

/// Returns the first contact of a run; kNull: there is none.
trace::EventId first_contact(const trace::Trace& trace);

}  // namespace lrb::run
