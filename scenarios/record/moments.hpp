#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::record {

/// Returns the events after which pictures are taken, ascending, at most spec.most of them. Throws InputError
/// for events that the trace does not have, and for passes if it is not a construction.
std::vector<trace::EventId> moments(const pictures::FrameSpec& spec, const trace::Trace& trace);

/// Returns the index of the size that differs least from this one, as a ratio.
std::size_t nearest_by_ratio(std::span<const double> sizes, double size);
/// Returns the indices of `count` sizes in about equal ratios from the first to the last; one index may occur
/// several times.
std::vector<std::size_t> by_ratio(std::span<const double> sizes, std::size_t count);

/// Returns the last stored event of a step.
trace::EventId last_event(const trace::Trace& trace, std::size_t step);

// Selects the events for a page, if a trace has more than a page should.

struct ThinnedEvents {
  std::vector<trace::EventId> kept;  ///< ascending
  /// Number of steps kept. For each of them `kept` contains all events that change a wrapper, so that it can
  /// be replayed; the other steps have no events.
  std::size_t steps = 0;
  /// The single remaining step has more such events than the limit: only the first of them are kept.
  bool cut = false;

  bool all(const trace::Trace& trace) const { return kept.size() == trace.events.size(); }
};

/// Keeps at most `most` events: all if they fit; otherwise the wrapper changes, of evenly spaced steps if
/// needed, then contacts, then evenly spaced ones of the rest. The first contact is always kept.
ThinnedEvents thin_events(const trace::Trace& trace, std::size_t most);

/// Returns the first contact of a run, or kNull if there is none.
trace::EventId first_contact(const trace::Trace& trace);

}  // namespace lrb::record
