#pragma once
/// The names that enumerators have in files, one table for both directions.

#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "engine/query/collide.hpp"
#include "engine/query/walk/probe.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

template <class Enum>
struct Names;  ///< specialised below: `values`, in the order of the enumerators

template <>
struct Names<EventKind> {
#define LRB_EVENT(name, json, a, b) json,
  static constexpr std::string_view values[] = {LRB_EVENTS(LRB_EVENT)};
#undef LRB_EVENT
};
template <>
struct Names<Side> {
  static constexpr std::string_view values[] = {"A", "B"};
};
template <>
struct Names<exact::Meet> {
  static constexpr std::string_view values[] = {"disjoint", "touch", "cross"};
};
template <>
struct Names<Clock> {
  static constexpr std::string_view values[] = {"event", "wall"};
};
template <>
struct Names<Mode> {
  static constexpr std::string_view values[] = {"all", "first", "any"};
};
template <>
struct Names<Recursion> {
  static constexpr std::string_view values[] = {"complete", "paper", "paper_strict"};
};
template <>
struct Names<Predicates> {
  static constexpr std::string_view values[] = {"exact", "floating"};
};
template <>
struct Names<WrapperMode> {
  static constexpr std::string_view values[] = {"regularised", "unregularised"};
};
template <>
struct Names<Relation> {
  static constexpr std::string_view values[] = {"separate",   "crossing",  "touching",  "a_inside_b",
                                                "b_inside_a", "undefined", "unresolved"};
};
template <>
struct Names<Answer> {
  static constexpr std::string_view values[] = {"no", "yes", "unknown"};
};

template <class Enum>
constexpr std::string_view name_of(Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < std::size(Names<Enum>::values) ? Names<Enum>::values[i] : "?";
}

template <class Enum>
constexpr std::optional<Enum> from_name(std::string_view name) {
  for (std::size_t i = 0; i < std::size(Names<Enum>::values); ++i)
    if (Names<Enum>::values[i] == name) return static_cast<Enum>(i);
  return std::nullopt;
}

/// "a, b or c".
template <class Enum>
std::string all_names() {
  std::string out;
  constexpr std::size_t n = std::size(Names<Enum>::values);
  for (std::size_t i = 0; i < n; ++i)
    out.append(i == 0 ? "" : i + 1 == n ? " or " : ", ").append(Names<Enum>::values[i]);
  return out;
}

/// What an event's numbers `a` and `b` are called; empty: the kind has no such number.
struct EventFields {
  std::string_view a, b;
};
constexpr EventFields fields_of(EventKind kind) {
#define LRB_EVENT(name, json, a, b) EventFields{a, b},
  constexpr EventFields fields[] = {LRB_EVENTS(LRB_EVENT)};
#undef LRB_EVENT
  return fields[static_cast<std::size_t>(kind)];
}
/// What a contact's number is called where it is a pseudo simplex: in the answers of coarse queries.
constexpr std::string_view pseudo_simplex(Side side) {
  return side == Side::a ? "pseudo simplex of A" : "pseudo simplex of B";
}
inline constexpr std::size_t kEventKinds = std::size(Names<EventKind>::values);

}  // namespace lrb::trace
