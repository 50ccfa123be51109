#pragma once
/// What a query can tell of its work beside face tests and refinements: pairs of tree nodes, tests by planes,
/// points that are located, and where its phases begin and end.

#include <cstdint>

#include <lrbscope/collide.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/enum_words.hpp>
#include <lrbscope/ids.hpp>

namespace lrb {

/// How much of a query is told. Each level tells what the ones before it tell, too.
enum class EventLevel : std::uint8_t {
  faces,  ///< face tests, refinements and contacts
  nodes,  ///< pairs of tree nodes, points that are located, phases, and how face tests were decided
  all,    ///< pairs of simplices that a plane parts
};
constexpr auto words_of(EventLevel) {
  return std::to_array<EnumWord<EventLevel>>(
      {{EventLevel::faces, "faces"}, {EventLevel::nodes, "nodes"}, {EventLevel::all, "all"}});
}

/// A part of a query. Its count, which is told at its end, is given beside it.
enum class Phase : std::uint8_t {
  walk,        ///< descends both trees and tests what is left: pairs of nodes
  sort,        ///< sorts the pairs that were found: pairs
  relation,    ///< finds how the bodies lie to each other: points located
  separation,  ///< looks for wrappers that prove the bodies apart: faces of both; 0: none
  contacts,    ///< computes the geometry of contact: contact regions
  kept,        ///< coherent: shows again the regions that earlier queries opened: regions
  cache,       ///< coherent: walks both trees for pairs that may meet on the way ahead: pairs kept
  cached,      ///< coherent: tests the pairs of the cache that may meet here: pairs of the cache that need no
               ///< test
};
constexpr auto words_of(Phase) {
  return std::to_array<EnumWord<Phase>>({{Phase::walk, "tree walk"},
                                         {Phase::sort, "sorting"},
                                         {Phase::relation, "relation"},
                                         {Phase::separation, "separation"},
                                         {Phase::contacts, "contact geometry"},
                                         {Phase::kept, "wrappers kept"},
                                         {Phase::cache, "cache making"},
                                         {Phase::cached, "cached pairs"}});
}
/// Returns true if pairs of tree nodes are visited in the phase.
constexpr bool walks_trees(Phase phase) {
  return phase == Phase::walk || phase == Phase::cache;
}

/// What the query does with a pair of tree nodes.
enum class NodeStep : std::uint8_t {
  descend_both,  ///< compares the boxes of A's children with those of B's
  descend_a,     ///< compares the boxes of A's children with B's whole box
  descend_b,     ///< compares the boxes of B's children with A's whole box
  leaves,        ///< compares the simplices of two leaves: first their boxes, then by their planes
  whole,         ///< compares the nodes' own boxes, which are apart
};
constexpr auto words_of(NodeStep) {
  return std::to_array<EnumWord<NodeStep>>({{NodeStep::descend_both, "both"},
                                            {NodeStep::descend_a, "A"},
                                            {NodeStep::descend_b, "B"},
                                            {NodeStep::leaves, "leaves"},
                                            {NodeStep::whole, "whole"}});
}

/// A pair of tree nodes that the query came to.
struct NodeVisit {
  std::uint32_t a = 0, b = 0;    ///< the nodes
  std::uint32_t parent = kNull;  ///< what the probe returned for the pair above; kNull: these are the roots
  NodeStep step = NodeStep::descend_both;
  std::uint8_t box_tests = 0;  ///< box against box
  std::uint8_t met = 0;        ///< pairs of boxes that meet: pairs of nodes to be visited, or of simplices
  std::uint8_t parted = 0;     ///< leaves: pairs of simplices whose boxes meet, but that a plane parts
  std::uint8_t certain = 0;    ///< leaves: those of the rest about which floats are certain
};

/// What decided a face test.
enum class TestedBy : std::uint8_t {
  untold,          ///< not told at this level of events
  floats,          ///< the tree's kernel, in floats with bounded errors
  shared_corners,  ///< the same, and that corners are equal
  filter,          ///< exact predicates whose floating-point filters were certain
  expansions,      ///< exact predicates, at least one of them by exact arithmetic
};
constexpr auto words_of(TestedBy) {
  return std::to_array<EnumWord<TestedBy>>({{TestedBy::untold, "untold"},
                                            {TestedBy::floats, "floats"},
                                            {TestedBy::shared_corners, "shared corners"},
                                            {TestedBy::filter, "filter"},
                                            {TestedBy::expansions, "expansions"}});
}

/// Where a point lies to a closed body.
enum class Where : std::uint8_t { outside, inside, on_surface };
constexpr auto words_of(Where) {
  return std::to_array<EnumWord<Where>>(
      {{Where::outside, "outside"}, {Where::inside, "inside"}, {Where::on_surface, "on the surface"}});
}

// Watching a query from outside the engine: derive from CollideProbe, override what is of interest, and give
// it to collide(). The answer is the same as without; each event costs a virtual call.

class CollideProbe {
 public:
  virtual ~CollideProbe() = default;
  /// A simplex of A was compared exactly with one of B. depth_a, depth_b: number of regions between each and
  /// the outside.
  virtual void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a,
                         std::uint32_t depth_b);
  /// A region of a body's wrapper was refined, which brought in as many faces. After a face test that hit,
  /// that test is the cause.
  virtual void refine(Side side, RegionId region, std::uint32_t faces_added);
  /// A region was taken back in: a coarse query has asked the bodies for a first pair and goes on with
  /// wrappers.
  virtual void coarsen(Side side, RegionId region, std::uint32_t faces_removed);
  /// Two simplices meet: part of the answer. They are real, but for coarse queries.
  virtual void contact(SimplexId a, SimplexId b, exact::Meet meet);

  /// Returns how much is to be told, which must not change during a query. What follows is told only from
  /// EventLevel::nodes on.
  virtual EventLevel level() const;
  /// The walk came to a pair of nodes. Returns what is to stand for it as NodeVisit::parent of pairs beneath
  /// it.
  virtual std::uint32_t node_pair(const NodeVisit& visit);
  /// Told at EventLevel::all: the plane of the simplex of `whose` body parts two simplices.
  virtual void plane_test(SimplexId a, SimplexId b, Side whose);
  /// What decided the face test that was told last.
  virtual void tested_by(TestedBy how);
  /// A vertex of `whose` body was located in the other one.
  virtual void point(Side whose, VertexId v, Where where);
  /// A phase begins. walked_a, walked_b: what is walked of each body: 0 for the body, i + 1 for level i.
  virtual void begin(Phase phase, std::uint32_t walked_a, std::uint32_t walked_b);
  /// The phase that began last ends; Phase says what `count` counts.
  virtual void end(Phase phase, std::uint64_t count);
};

/// Does what collide() in collide.hpp does, and tells the probe everything that happens, in order. What the
/// probe throws ends the query.
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request, CollideProbe& probe);

// The probe: what the query reports to an observer. It is a template parameter: with NullProbe every call
// vanishes.

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
