#include "scenarios/golden/diagnosis.hpp"

#include <algorithm>
#include <span>

#include "trace/counters.hpp"

namespace lrb::golden {
namespace {

using Events = std::span<const trace::Event>;

/// Returns true if two events do the same, whatever caused them: causes are numbers of events, which shift.
bool same_action(const trace::Event& x, const trace::Event& y) {
  return x.kind == y.kind && x.side == y.side && x.a == y.a && x.b == y.b && x.meet == y.meet;
}

/// Returns the index of the next event after `from` that does the same; events.size(): there is none.
std::size_t find_after(Events events, std::size_t from, const trace::Event& action) {
  for (std::size_t i = from + 1; i < events.size(); ++i)
    if (same_action(events[i], action)) return i;
  return events.size();
}

/// Returns "; the step has 53 contacts instead of 54", or nothing.
std::string contacts_words(Events expected, Events actual) {
  const std::uint64_t x = trace::count_events(expected).contacts, y = trace::count_events(actual).contacts;
  return x == y ? ""
                : "; the step has " + std::to_string(y) + (y == 1 ? " contact" : " contacts") +
                      " instead of " + std::to_string(x);
}

std::string several(const char* what, std::size_t count, trace::EventId first, const trace::Event& event) {
  if (count == 1) return "event " + std::to_string(first) + " " + what + ": " + trace::describe(event);
  return std::to_string(count) + " events " + what + ", event " + std::to_string(first) +
         " first: " + trace::describe(event);
}

}  // namespace

std::string diagnose(const trace::Trace& expected, const trace::Trace& actual,
                     const trace::Divergence& divergence) {
  if (!divergence.event || !divergence.step) return {};
  const Events x = expected.events_of(*divergence.step), y = actual.events_of(*divergence.step);
  const trace::EventId event = *divergence.event;
  const std::size_t i = event - expected.steps[*divergence.step].first_event;
  const bool in_x = i < x.size(), in_y = i < y.size();
  if (!in_x && !in_y) return {};
  const std::string contacts = contacts_words(x, y);
  if (!in_y) return several("lost", x.size() - i, event, x[i]) + contacts;
  if (!in_x) return several("added", y.size() - i, event, y[i]) + contacts;
  if (x[i].kind == y[i].kind && x[i].side == y[i].side && x[i].a == y[i].a && x[i].b == y[i].b)
    return {};  // the same action with another outcome: the message names the field
  const std::size_t found_in_x = find_after(x, i, y[i]), found_in_y = find_after(y, i, x[i]);
  const bool y_comes = found_in_x < x.size(), x_comes = found_in_y < y.size();
  if (y_comes && x_comes) {
    if (found_in_x != found_in_y) return "events come in another order" + contacts;
    return "events " + std::to_string(event) + " and " + std::to_string(event + found_in_x - i) +
           " are swapped: " + trace::describe(x[i]) + "; " + trace::describe(y[i]) + contacts;
  }
  if (y_comes) return several("lost", found_in_x - i, event, x[i]) + contacts;
  if (x_comes) return several("added", found_in_y - i, event, y[i]) + contacts;
  return "expected " + trace::describe(x[i]) + "; found " + trace::describe(y[i]) + contacts;
}

}  // namespace lrb::golden
