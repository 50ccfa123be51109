#pragma once
/// The probe: what the query reports to an observer. It is a template parameter: with NullProbe every call
/// vanishes.

#include <cstdint>

#include "engine/core/ids.hpp"
#include "engine/exact/simplex_test.hpp"

namespace lrb {

/// The events of a query, in one table: enumerator, name in traces, meaning of the fields a and b.
/// LRB_EVENT(enumerator, json_name, meaning of a, meaning of b)
#define LRB_EVENTS(LRB_EVENT)                                             \
  LRB_EVENT(step, "step", "time step", "")                                \
  LRB_EVENT(face_test, "face test", "simplex of A", "simplex of B")       \
  LRB_EVENT(refine, "refine", "region", "faces added")                    \
  LRB_EVENT(coarsen, "coarsen", "region", "faces removed")                \
  LRB_EVENT(contact, "contact", "real simplex of A", "real simplex of B") \
  LRB_EVENT(result, "result", "relation", "pairs")

enum class EventKind : std::uint8_t {
#define LRB_EVENT(name, json, a, b) name,
  LRB_EVENTS(LRB_EVENT)
#undef LRB_EVENT
};
constexpr auto words_of(EventKind) {
#define LRB_EVENT(name, json, a, b) {EventKind::name, json},
  return std::to_array<EnumWord<EventKind>>({LRB_EVENTS(LRB_EVENT)});
#undef LRB_EVENT
}

/// Does nothing and costs nothing. Also the list of what a probe must have.
struct NullProbe {
  static constexpr bool kEnabled = false;
  /// A simplex of A was compared exactly with one of B. depth_a/b: number of regions between each and the
  /// outside.
  void face_test(SimplexId, SimplexId, exact::Meet, std::uint32_t /*depth_a*/, std::uint32_t /*depth_b*/) {}
  /// A region of a body's wrapper was refined. If a face test that hit came before, that test is the cause.
  void refine(Side, RegionId, std::uint32_t /*faces_added*/) {}
  /// A region was taken back in: what refined it was not for the wrapper that is queried next.
  void coarsen(Side, RegionId, std::uint32_t /*faces_removed*/) {}
  /// Two real simplices meet; they are part of the answer.
  void contact(SimplexId, SimplexId, exact::Meet) {}
};

}  // namespace lrb
