#pragma once
/// The words that files and messages use for what a trace holds.

#include <cstddef>
#include <string_view>

#include "engine/core/enum_words.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/walk/probe.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

using lrb::all_names;
using lrb::from_name;
using lrb::name_of;

/// The names of an event's numbers `a` and `b`; empty: the kind has no such number.
struct EventFields {
  std::string_view a, b;
};
constexpr EventFields fields_of(EventKind kind) {
#define LRB_EVENT(name, json, a, b) EventFields{a, b},
  constexpr EventFields fields[] = {LRB_EVENTS(LRB_EVENT)};
#undef LRB_EVENT
  return fields[static_cast<std::size_t>(kind)];
}
/// Returns the name of a contact's number where it is a pseudo simplex, which happens in answers of coarse
/// queries.
constexpr std::string_view pseudo_simplex(Side side) {
  return side == Side::a ? "pseudo simplex of A" : "pseudo simplex of B";
}
inline constexpr std::size_t kEventKinds = kWords<EventKind>.size();

}  // namespace lrb::trace
