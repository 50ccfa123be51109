#include "trace/node_work.hpp"

#include <string>

#include "engine/core/error.hpp"
#include "engine/lrb/wrapper_level.hpp"

namespace lrb::trace {

const ObbTree& walked_tree(const LrbRep& rep, std::uint32_t walked) {
  if (walked == 0) return rep.tree();
  const std::span<const WrapperLevel> levels = rep.levels().all();
  if (walked > levels.size())
    throw InputError("body " + rep.name() + ": the trace walks its level " + std::to_string(walked - 1) +
                     ", but it has " + std::to_string(levels.size()) +
                     "; the trace is damaged: record it again");
  return levels[walked - 1].tree;
}

NodeCounts count_nodes(const TreeShape& tree, Side side, std::span<const Event> events) {
  const std::vector<std::uint32_t> none(tree.size());
  NodeCounts counts{none, none, none};
  // Node numbers of levels of detail refer to other trees: count the body's own traversal only.
  bool is_body = true;
  for (const Event& e : events) {
    if (e.kind == EventKind::begin && walks_trees(e.phase()))
      is_body = (side == Side::a ? e.depth_a : e.depth_b) == 0;
    if (e.kind != EventKind::node_pair || !is_body) continue;
    const std::uint32_t node = side == Side::a ? e.a : e.b;
    if (node >= tree.size())
      throw InputError("the trace visits node " + std::to_string(node) + " of " + std::string(name_of(side)) +
                       "'s tree, which has " + std::to_string(tree.size()) +
                       "; the trace is damaged: record it again");
    ++counts.visits[node];
    counts.ended[node] += e.work().met == 0;
    counts.box_tests[node] += e.work().box_tests;
  }
  return counts;
}

std::vector<double> box_tests_by_face(const LrbRep& rep, const TreeShape& tree, const NodeCounts& counts) {
  std::vector<double> out(rep.face_count());
  std::vector<double> share(tree.size());  // of the node and those above, for each simplex
  // Distribute each node's tests evenly over the simplices beneath it, as a prefix sum from the root:
  // O(nodes).
  for (const std::uint32_t node : tree.from_root()) {
    share[node] += static_cast<double>(counts.box_tests[node]) / tree.beneath(node);
    for (const std::uint32_t child : tree.children(node)) share[child] = share[node];
    for (const SimplexId s : tree.simplices(node)) out[rep.face_of_simplex(s)] += share[node];
  }
  return out;
}

std::vector<DepthWork> work_by_depth(const TreeShape& tree, const NodeCounts& counts) {
  std::vector<DepthWork> out;
  const double root = tree.size() > 0 ? tree.box(0).area() : 0;
  for (const std::uint32_t n : tree.from_root()) {
    if (tree.depth(n) >= out.size()) out.resize(tree.depth(n) + 1);
    DepthWork& w = out[tree.depth(n)];
    ++w.nodes;
    // Surface area heuristic: the probability that a line through the root also hits the node.
    w.expected += root > 0 ? tree.box(n).area() / root : 0;
    w.nodes_visited += counts.visits[n] > 0;
    w.visits += counts.visits[n];
    w.ended += counts.ended[n];
    w.box_tests += counts.box_tests[n];
  }
  return out;
}

}  // namespace lrb::trace
