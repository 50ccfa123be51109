#include "trace/node_work.hpp"

#include <string>

#include "engine/core/error.hpp"
#include "engine/lrb/wrapper_level.hpp"
#include "engine/tree/tree_quality.hpp"

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

NodeCounts count_nodes(const LrbRep& rep, Side side, std::span<const Event> events) {
  const std::size_t n = rep.tree().nodes().size();
  NodeCounts counts{std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(n),
                    std::vector<std::uint32_t>(n)};
  bool is_body = true;
  for (const Event& e : events) {
    if (e.kind == EventKind::begin && e.phase() == Phase::walk)
      is_body = (side == Side::a ? e.depth_a : e.depth_b) == 0;
    if (e.kind != EventKind::node_pair || !is_body) continue;
    const std::uint32_t node = side == Side::a ? e.a : e.b;
    if (node >= n)
      throw InputError("body " + rep.name() + ": the trace visits node " + std::to_string(node) +
                       " of its tree, which has " + std::to_string(n) +
                       "; the trace is damaged: record it again");
    ++counts.visits[node];
    counts.ended[node] += e.work().met == 0;
    counts.box_tests[node] += e.work().box_tests;
  }
  return counts;
}

std::vector<double> box_tests_by_face(const LrbRep& rep, const NodeCounts& counts) {
  std::vector<double> out(rep.face_count());
  const ObbTree& tree = rep.tree();
  if (tree.empty()) return out;
  const std::vector<std::uint32_t> beneath = simplices_beneath(tree);
  struct Visit {
    std::uint32_t node;
    double share;  // of the nodes above, for each simplex
  };
  std::vector<Visit> stack = {{0, 0}};
  while (!stack.empty()) {
    const Visit v = stack.back();
    stack.pop_back();
    const TreeNode& node = tree.nodes()[v.node];
    const double share = v.share + static_cast<double>(counts.box_tests[v.node]) / beneath[v.node];
    for (std::uint32_t k = 0; k < node.count; ++k)
      if (node.is_leaf)
        out[rep.face_of_simplex(tree.blocks()[node.first].simplex[k])] += share;
      else
        stack.push_back({node.first + k, share});
  }
  return out;
}

std::vector<DepthWork> work_by_depth(const LrbRep& rep, const NodeCounts& counts) {
  const ObbTree& tree = rep.tree();
  std::vector<DepthWork> out;
  if (tree.empty()) return out;
  const double root = node_area(tree, 0);
  const std::vector<std::uint32_t> depth = node_depths(tree);
  for (std::uint32_t n = 0; n < depth.size(); ++n) {
    if (depth[n] >= out.size()) out.resize(depth[n] + 1);
    DepthWork& w = out[depth[n]];
    ++w.nodes;
    w.expected += root > 0 ? node_area(tree, n) / root : 0;
    w.nodes_visited += counts.visits[n] > 0;
    w.visits += counts.visits[n];
    w.ended += counts.ended[n];
    w.box_tests += counts.box_tests[n];
  }
  return out;
}

}  // namespace lrb::trace
