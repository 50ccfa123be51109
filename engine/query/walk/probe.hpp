#pragma once
/// The probe: what the query reports to an observer. It is a template parameter: with NullProbe every call
/// vanishes.

#include <cstdint>

#include "engine/core/ids.hpp"
#include "engine/exact/simplex_test.hpp"
#include "engine/query/walk/watch.hpp"

namespace lrb {

/// The events of a query and, from pass on, of a construction (ConstructProbe), in one table: enumerator,
/// name in traces, meaning of the fields a and b.
/// LRB_EVENT(enumerator, json_name, meaning of a, meaning of b)
#define LRB_EVENTS(LRB_EVENT)                                                     \
  LRB_EVENT(step, "step", "time step", "")                                        \
  LRB_EVENT(face_test, "face test", "simplex of A", "simplex of B")               \
  LRB_EVENT(refine, "refine", "region", "faces added")                            \
  LRB_EVENT(coarsen, "coarsen", "region", "faces removed")                        \
  LRB_EVENT(contact, "contact", "real simplex of A", "real simplex of B")         \
  LRB_EVENT(result, "result", "relation", "pairs")                                \
  LRB_EVENT(node_pair, "node pair", "node of A", "node of B")                     \
  LRB_EVENT(plane_test, "plane test", "simplex of A", "simplex of B")             \
  LRB_EVENT(point, "point", "vertex", "")                                         \
  LRB_EVENT(begin, "begin", "phase", "")                                          \
  LRB_EVENT(end, "end", "phase", "count")                                         \
  LRB_EVENT(pass, "pass", "layer", "faces barred")                                \
  LRB_EVENT(patch, "patch", "vertex", "faces")                                    \
  LRB_EVENT(cap, "cap", "faces", "faces covered")                                 \
  LRB_EVENT(region, "region", "region", "faces covered")                          \
  LRB_EVENT(merged, "merged", "region", "pieces")                                 \
  LRB_EVENT(pass_end, "pass end", "vertices without patch", "vertices that wait") \
  LRB_EVENT(closed, "closed", "regions", "outermost faces")

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
  /// How much is to be told. What follows contact() is told only from EventLevel::nodes on.
  EventLevel level() const { return EventLevel::faces; }
  /// A simplex of A was compared exactly with one of B. depth_a/b: number of regions between each and the
  /// outside.
  void face_test(SimplexId, SimplexId, exact::Meet, std::uint32_t /*depth_a*/, std::uint32_t /*depth_b*/) {}
  /// A region of a body's wrapper was refined. If a face test that hit came before, that test is the cause.
  void refine(Side, RegionId, std::uint32_t /*faces_added*/) {}
  /// A region was taken back in: what refined it was not for the wrapper that is queried next.
  void coarsen(Side, RegionId, std::uint32_t /*faces_removed*/) {}
  /// Two real simplices meet; they are part of the answer.
  void contact(SimplexId, SimplexId, exact::Meet) {}

  /// The walk came to a pair of nodes. Returns what stands for it as NodeVisit::parent of pairs beneath it.
  std::uint32_t node_pair(const NodeVisit&) { return kNull; }
  /// Told at EventLevel::all: a plane parts two simplices, that of the one of `whose`. They are of the leaves
  /// of the pair of nodes that was told last.
  void plane_test(SimplexId, SimplexId, Side /*whose*/) {}
  /// What decided the face test that was told last.
  void tested_by(TestedBy) {}
  /// A vertex of `whose` body was located in the other one.
  void point(Side /*whose*/, VertexId, Where) {}
  /// A phase begins. walked_a/b: what is walked of each body: 0 for the body itself, i + 1 for level i.
  void begin(Phase, std::uint32_t /*walked_a*/, std::uint32_t /*walked_b*/) {}
  /// The phase that began last ends.
  void end(Phase, std::uint64_t /*count*/) {}
};

/// Returns true if a probe is told more than face tests, refinements and contacts.
template <class Probe>
bool is_told_more(const Probe& probe) {
  if constexpr (Probe::kEnabled) return probe.level() != EventLevel::faces;
  return false;
}

/// Does a phase of a query and tells the probe where it begins and ends. work() returns the phase's count.
template <class Probe, class Work>
void in_phase(Probe& probe, Phase phase, const Work& work) {
  if (!is_told_more(probe)) {
    work();
    return;
  }
  probe.begin(phase, 0, 0);
  probe.end(phase, work());
}

/// Locates points as a phase. work(see) calls see(side, vertex, where) for each point.
template <class Probe, class Work>
void locate_in_phase(Probe& probe, const Work& work) {
  in_phase(probe, Phase::relation, [&] {
    std::uint64_t points = 0;
    work([&](Side side, VertexId v, Where where) {
      ++points;
      if (is_told_more(probe)) probe.point(side, v, where);
    });
    return points;
  });
}

}  // namespace lrb
