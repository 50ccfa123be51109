#pragma once
/// Observation of queries: face tests, refinements and contacts, and at higher event levels pairs of tree
/// nodes, plane tests, located points and phases.

#include <cstdint>

#include <lrbscope/collide.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/ids.hpp>

namespace lrb {

/// The amount of detail reported. Each level includes those before it.
enum class EventLevel : std::uint8_t {
  faces,  ///< face tests, refinements and contacts
  nodes,  ///< pairs of tree nodes, located points, phases, and the method that decided each face test
  all,    ///< pairs of simplices separated by a plane
};
constexpr auto enum_names(EventLevel) {
  return std::to_array<EnumName<EventLevel>>(
      {{EventLevel::faces, "faces"}, {EventLevel::nodes, "nodes"}, {EventLevel::all, "all"}});
}

/// A part of a query. The quantity reported as its count is given after each colon.
enum class Phase : std::uint8_t {
  walk,        ///< traverses both trees and tests the remaining faces: pairs of nodes
  sort,        ///< sorts the pairs found: pairs
  relation,    ///< determines the relation of the bodies: points located
  separation,  ///< searches for wrappers that prove the bodies separate: faces of both; 0: none
  contacts,    ///< computes the contact geometry: contact regions
  kept,        ///< coherent: reports again the regions refined by earlier queries: regions
  cache,   ///< coherent: traverses both trees for pairs that may intersect in the motion ahead: pairs cached
  cached,  ///< coherent: tests the cached pairs that may intersect at this pose: cached pairs that need no
           ///< test
};
constexpr auto enum_names(Phase) {
  return std::to_array<EnumName<Phase>>({{Phase::walk, "tree walk"},
                                         {Phase::sort, "sorting"},
                                         {Phase::relation, "relation"},
                                         {Phase::separation, "separation"},
                                         {Phase::contacts, "contact geometry"},
                                         {Phase::kept, "wrappers kept"},
                                         {Phase::cache, "cache making"},
                                         {Phase::cached, "cached pairs"}});
}
/// Returns true if the phase visits pairs of tree nodes.
constexpr bool walks_trees(Phase phase) {
  return phase == Phase::walk || phase == Phase::cache;
}

/// The operation on a pair of tree nodes.
enum class NodeStep : std::uint8_t {
  descend_both,  ///< tests the boxes of A's children against those of B's
  descend_a,     ///< tests the boxes of A's children against the box of B's node
  descend_b,     ///< tests the boxes of B's children against the box of A's node
  leaves,        ///< tests the simplices of two leaves: first their boxes, then their planes
  whole,         ///< rejects the pair by the OBBs of the two nodes
};
constexpr auto enum_names(NodeStep) {
  return std::to_array<EnumName<NodeStep>>({{NodeStep::descend_both, "both"},
                                            {NodeStep::descend_a, "A"},
                                            {NodeStep::descend_b, "B"},
                                            {NodeStep::leaves, "leaves"},
                                            {NodeStep::whole, "whole"}});
}

/// A pair of tree nodes visited by the query.
struct NodeVisit {
  std::uint32_t a = 0, b = 0;    ///< node indices in A's tree and in B's
  std::uint32_t parent = kNull;  ///< the value that the probe returned for the parent pair; kNull for the
                                 ///< roots
  NodeStep step = NodeStep::descend_both;
  std::uint8_t box_tests = 0;  ///< tests of two boxes
  std::uint8_t met = 0;  ///< pairs of boxes that intersect: pairs of nodes to be visited, or of simplices
  std::uint8_t rejected = 0;  ///< leaves: pairs of simplices with intersecting boxes that a plane separates
  std::uint8_t certain = 0;   ///< leaves: remaining pairs that are decided in floats
};

/// The method that decided a face test.
enum class TestedBy : std::uint8_t {
  unreported,      ///< not reported at this event level
  floats,          ///< the tree's kernel, in floats with bounded errors
  shared_corners,  ///< the same, using that corners are equal
  filter,          ///< exact predicates, all decided by their floating-point filters
  expansions,      ///< exact predicates, at least one of them in exact arithmetic
};
constexpr auto enum_names(TestedBy) {
  return std::to_array<EnumName<TestedBy>>({{TestedBy::unreported, "untold"},
                                            {TestedBy::floats, "floats"},
                                            {TestedBy::shared_corners, "shared corners"},
                                            {TestedBy::filter, "filter"},
                                            {TestedBy::expansions, "expansions"}});
}

/// The location of a point relative to a closed body.
enum class Where : std::uint8_t { outside, inside, on_surface };
constexpr auto enum_names(Where) {
  return std::to_array<EnumName<Where>>(
      {{Where::outside, "outside"}, {Where::inside, "inside"}, {Where::on_surface, "on the surface"}});
}

// Observing a query: derive from CollideProbe, override the callbacks of interest, and pass it to collide().
// The answer is the same with and without a probe. Each event costs a virtual call.

class CollideProbe {
 public:
  virtual ~CollideProbe() = default;
  /// A simplex of A was tested exactly against one of B. depth_a, depth_b: number of regions between each of
  /// them and the outside.
  virtual void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a,
                         std::uint32_t depth_b);
  /// A region of a body's wrapper was refined, which added `faces_added` faces. If it follows a face test
  /// that hit, that test is the cause.
  virtual void refine(Side side, RegionId region, std::uint32_t faces_added);
  /// A region was included again: a coarse query has searched the bodies for a first pair and continues with
  /// wrappers.
  virtual void coarsen(Side side, RegionId region, std::uint32_t faces_removed);
  /// Two simplices intersect; the pair is part of the answer. They are real, except in coarse queries.
  virtual void contact(SimplexId a, SimplexId b, exact::Meet meet);

  /// Returns the event level, which must be constant during a query. The callbacks below require at least
  /// EventLevel::nodes.
  virtual EventLevel level() const;
  /// The traversal visited a pair of nodes. Returns the value to be passed as NodeVisit::parent for the pairs
  /// beneath it.
  virtual std::uint32_t node_pair(const NodeVisit& visit);
  /// EventLevel::all only: the plane of the simplex of the body `whose` separates two simplices.
  virtual void plane_test(SimplexId a, SimplexId b, Side whose);
  /// The method that decided the face test reported last.
  virtual void tested_by(TestedBy how);
  /// A vertex of the body `whose` was located relative to the other body.
  virtual void point(Side whose, VertexId v, Where where);
  /// A phase begins. walked_a, walked_b: the traversed representation of each body: 0 for the body, i + 1 for
  /// level i.
  virtual void begin(Phase phase, std::uint32_t walked_a, std::uint32_t walked_b);
  /// The current phase ends. `count`: see Phase.
  virtual void end(Phase phase, std::uint64_t count);
};

/// Returns the same as collide() without a probe, and reports all events in order. An exception thrown by the
/// probe ends the query.
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request, CollideProbe& probe);

// The static probe interface of the query templates. With NullProbe every call is compiled away.

/// The events of a query and, from `pass` on, of a build (ConstructProbe): enumerator, name in traces,
/// meaning of the fields a and b.
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
  LRB_EVENT(pass, "pass", "layer", "faces barred") /* language: keep */           \
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
constexpr auto enum_names(EventKind) {
#define LRB_EVENT(name, json, a, b) {EventKind::name, json},
  return std::to_array<EnumName<EventKind>>({LRB_EVENTS(LRB_EVENT)});
#undef LRB_EVENT
}

/// A probe that does nothing at no cost. Also documents the interface of a probe.
struct NullProbe {
  static constexpr bool kEnabled = false;
  /// The event level. The callbacks below contact() require at least EventLevel::nodes.
  EventLevel level() const { return EventLevel::faces; }
  /// A simplex of A was tested exactly against one of B. depth_a/b: number of regions between each of them
  /// and the outside.
  void face_test(SimplexId, SimplexId, exact::Meet, std::uint32_t /*depth_a*/, std::uint32_t /*depth_b*/) {}
  /// A region of a body's wrapper was refined. If it follows a face test that hit, that test is the cause.
  void refine(Side, RegionId, std::uint32_t /*faces_added*/) {}
  /// A region was included again: its refinement does not apply to the wrapper that is queried next.
  void coarsen(Side, RegionId, std::uint32_t /*faces_removed*/) {}
  /// Two real simplices intersect; the pair is part of the answer.
  void contact(SimplexId, SimplexId, exact::Meet) {}

  /// The traversal visited a pair of nodes. Returns the value of NodeVisit::parent for the pairs beneath it.
  std::uint32_t node_pair(const NodeVisit&) { return kNull; }
  /// EventLevel::all only: the plane of the simplex of `whose` separates two simplices, which belong to the
  /// leaves of the pair of nodes reported last.
  void plane_test(SimplexId, SimplexId, Side /*whose*/) {}
  /// The method that decided the face test reported last.
  void tested_by(TestedBy) {}
  /// A vertex of the body `whose` was located relative to the other body.
  void point(Side /*whose*/, VertexId, Where) {}
  /// A phase begins. walked_a/b: the traversed representation of each body: 0 for the body, i + 1 for level
  /// i.
  void begin(Phase, std::uint32_t /*walked_a*/, std::uint32_t /*walked_b*/) {}
  /// The current phase ends.
  void end(Phase, std::uint64_t /*count*/) {}
};

/// Returns true if the probe's event level is above EventLevel::faces.
template <class Probe>
bool reports_details(const Probe& probe) {
  if constexpr (Probe::kEnabled) return probe.level() != EventLevel::faces;
  return false;
}

/// Runs a phase of a query and reports its begin and end to the probe. work() returns the phase's count.
template <class Probe, class Work>
void in_phase(Probe& probe, Phase phase, const Work& work) {
  if (!reports_details(probe)) {
    work();
    return;
  }
  probe.begin(phase, 0, 0);
  probe.end(phase, work());
}

/// Runs a point location phase. work(visit) calls visit(side, vertex, where) for each point.
template <class Probe, class Work>
void locate_in_phase(Probe& probe, const Work& work) {
  in_phase(probe, Phase::relation, [&] {
    std::uint64_t points = 0;
    work([&](Side side, VertexId v, Where where) {
      ++points;
      if (reports_details(probe)) probe.point(side, v, where);
    });
    return points;
  });
}

}  // namespace lrb
