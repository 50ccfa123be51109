#pragma once
/// Where the work of the tree walk went, from a trace's events from EventLevel::nodes on: by node of a tree,
/// by depth of nodes, and by face.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "trace/trace.hpp"
#include "trace/tree_shape.hpp"

namespace lrb::trace {

/// Returns the tree that a walk descends of a body: its own, or that of a level (walked = 1 + its index).
/// Throws InputError if the body has no such level.
const ObbTree& walked_tree(const LrbRep& rep, std::uint32_t walked);

/// The work at each node of a body's own tree. All (nodes).
struct NodeCounts {
  std::vector<std::uint32_t> visits;     ///< pairs that the node was in
  std::vector<std::uint32_t> ended;      ///< those of them of which no two boxes met
  std::vector<std::uint32_t> box_tests;  ///< of these pairs
};
/// Counts over walks of the body itself; walks of levels are left out. `tree` is that of the body that was
/// recorded as `side`. Throws InputError if an event names a node that the tree does not have.
NodeCounts count_nodes(const TreeShape& tree, Side side, std::span<const Event> events);

/// Returns, for each face (|F|), the box tests of the nodes above it: each node's are shared evenly by the
/// simplices beneath it, so that the sum over all faces is that over all nodes.
std::vector<double> box_tests_by_face(const LrbRep& rep, const TreeShape& tree, const NodeCounts& counts);

/// The nodes of one depth of a body's tree, beside what the surface area heuristic expects.
struct DepthWork {
  std::uint32_t nodes = 0;
  double expected = 0;  ///< sum of the nodes' areas / the root's: how many of them a random line meets
  std::uint32_t nodes_visited = 0;  ///< different ones
  std::uint64_t visits = 0, ended = 0, box_tests = 0;
};
/// Returns the work by depth, the root's first.
std::vector<DepthWork> work_by_depth(const TreeShape& tree, const NodeCounts& counts);

}  // namespace lrb::trace
