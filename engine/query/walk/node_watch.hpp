#pragma once
/// Runs the tree kernel one pair of nodes at a time and tells a probe what came of each. The kernel, the
/// order of pairs and the outcome are those of a query that nobody watches.

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "engine/query/walk/probe.hpp"
#include "engine/query/walk/query_context.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {

/// Returns what the kernel does with a pair of nodes whose own boxes are not apart.
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
      : probe_(probe),
        parents_(ctx.parents),
        parted_(ctx.parted),
        parted_nodes_(ctx.parted_nodes),
        all_(probe.level() == EventLevel::all) {
    parted_.resize(kMostPairs);
    parted_nodes_.resize(ctx.stack.size());
  }

  /// Does what run_tree_kernel() does. May be called again, of another watch too, to go on.
  void run(TreeKernel& k) {
    const std::uint64_t most = k.most_node_pairs;
    if (k.node_pairs == 0) parents_.clear();
    k.parted = all_ ? parted_.data() : nullptr;
    k.parted_nodes = parted_nodes_.data();
    while (!is_done(k) && k.out_capacity - k.out_size >= kMostPairs && k.node_pairs < most) {
      k.most_node_pairs = k.node_pairs + 1;
      step(k);
    }
    k.most_node_pairs = most;
  }

 private:
  static constexpr std::uint32_t kMostPairs = kTreeWidth * kTreeWidth;

  void step(TreeKernel& k) {
    const std::uint32_t out_before = k.out_size;
    const std::uint64_t boxes_before = k.box_tests, pairs_before = k.prefilter_tests;
    k.parted_size = k.parted_nodes_size = 0;
    run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.parted_nodes_size; ++i) tell_parted(k.parted_nodes[i]);
    if (k.parted_nodes_size != 0) return;
    const NodePair& pair = k.opened;
    NodeVisit visit{.a = pair.a, .b = pair.b, .parent = take_parent(pair), .step = step_of(k, pair)};
    visit.box_tests = static_cast<std::uint8_t>(k.box_tests - boxes_before);
    visit.met = static_cast<std::uint8_t>(k.stack_size - k.opened_at);
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
    for (std::uint32_t i = k.opened_at; i < k.stack_size; ++i) parents_.emplace(key_of(k.stack[i]), told);
    for (std::uint32_t i = 0; i < k.parted_size; ++i)
      probe_.plane_test(k.parted[i].a, k.parted[i].b, k.parted[i].whose);
  }

  void tell_parted(const NodePair& pair) {
    probe_.node_pair(
        {.a = pair.a, .b = pair.b, .parent = take_parent(pair), .step = NodeStep::whole, .box_tests = 1});
  }

  static std::uint64_t key_of(const NodePair& pair) { return std::uint64_t{pair.a} << 32 | pair.b; }

  /// Returns what the probe returned for the pair above, and forgets it: each pair is visited once.
  std::uint32_t take_parent(const NodePair& pair) {
    const auto found = parents_.extract(key_of(pair));
    return found.empty() ? kNull : found.mapped();
  }

  Probe& probe_;
  std::unordered_map<std::uint64_t, std::uint32_t>& parents_;  ///< of pairs that wait: see take_parent()
  std::vector<PartedPair>& parted_;
  std::vector<NodePair>& parted_nodes_;
  bool all_;
};

}  // namespace lrb
