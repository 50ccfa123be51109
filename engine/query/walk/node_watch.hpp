#pragma once
/// Runs the tree kernel one pair of nodes at a time and tells a probe what came of each. The kernel, the
/// order of pairs and the outcome are those of a query that nobody watches.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/query/walk/probe.hpp"
#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// Returns what the kernel does with a pair of nodes that needles' directions do not part.
inline NodeStep step_of(const TreeKernel& k, const NodePair& pair) {
  const TreeNode &a = k.nodes_a[pair.a], &b = k.nodes_b[pair.b];
  const auto size = [&](const TreeNode& n, int side) {
    return n.radius * (k.affine != nullptr ? k.affine->span[side] : side == 0 ? k.ratio_a : k.ratio_b);
  };
  if (a.is_leaf && b.is_leaf) return NodeStep::leaves;
  const bool hold_a = a.is_leaf || size(b, 1) > kMuchLarger * size(a, 0);
  const bool hold_b = b.is_leaf || size(a, 0) > kMuchLarger * size(b, 1);
  if (!a.is_leaf && hold_b) return NodeStep::descend_a;
  return !b.is_leaf && hold_a ? NodeStep::descend_b : NodeStep::descend_both;
}

template <class Probe>
class NodeWatch {
 public:
  NodeWatch(QueryContext& ctx, Probe& probe)
      : probe_(probe), parents_(ctx.parents), parted_(ctx.parted), all_(probe.level() == EventLevel::all) {
    if (parents_.size() < ctx.stack.size()) parents_.resize(ctx.stack.size());
    parted_.resize(kMostPairs);
  }

  /// Does what run_tree_kernel() does. May be called again, of another watch too, to go on.
  void run(TreeKernel& k) {
    const std::uint64_t most = k.most_node_pairs;
    if (k.node_pairs == 0) parents_[0] = kNull;
    k.parted = all_ ? parted_.data() : nullptr;
    while (k.stack_size != 0 && k.out_capacity - k.out_size >= kMostPairs && k.node_pairs < most) {
      k.most_node_pairs = k.node_pairs + 1;
      step(k);
    }
    k.most_node_pairs = most;
  }

 private:
  static constexpr std::uint32_t kMostPairs = kTreeWidth * kTreeWidth;

  void step(TreeKernel& k) {
    const std::uint32_t top = k.stack_size - 1, out_before = k.out_size;
    const NodePair pair = k.stack[top];
    const std::uint64_t boxes_before = k.box_tests, pairs_before = k.prefilter_tests;
    k.parted_size = 0;
    run_tree_kernel(k);
    NodeVisit visit{.a = pair.a, .b = pair.b, .parent = parents_[top]};
    visit.box_tests = static_cast<std::uint8_t>(k.box_tests - boxes_before);
    visit.step = visit.box_tests == 0 ? NodeStep::needles : step_of(k, pair);
    visit.met = static_cast<std::uint8_t>(k.stack_size - top);
    if (visit.step == NodeStep::leaves) {
      const std::uint32_t left = k.out_size - out_before;
      visit.met = static_cast<std::uint8_t>(k.prefilter_tests - pairs_before);
      visit.parted = static_cast<std::uint8_t>(visit.met - left);
      visit.certain = static_cast<std::uint8_t>(
          std::count_if(k.out + out_before, k.out + k.out_size, [](const Candidate& c) {
            return c.certainty == Certainty::cross || c.certainty == Certainty::disjoint;
          }));
    }
    const std::uint32_t told = probe_.node_pair(visit);
    std::fill(parents_.begin() + top, parents_.begin() + k.stack_size, told);
    for (std::uint32_t i = 0; i < k.parted_size; ++i)
      probe_.plane_test(k.parted[i].a, k.parted[i].b, k.parted[i].whose);
  }

  Probe& probe_;
  std::vector<std::uint32_t>& parents_;  ///< (stack) what the probe returned for the pair above
  std::vector<PartedPair>& parted_;
  bool all_;
};

}  // namespace lrb
