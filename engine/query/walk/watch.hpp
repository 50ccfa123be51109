#pragma once
/// What a query can tell of its work beside face tests and refinements: pairs of tree nodes, tests by planes,
/// points that are located, and where its phases begin and end.

#include <cstdint>

#include "engine/core/enum_words.hpp"
#include "engine/core/ids.hpp"

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

}  // namespace lrb
