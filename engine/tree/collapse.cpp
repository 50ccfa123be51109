// Collapses a binary tree to a wide one by dynamic programming (Ylitie, Karras and Laine 2017, section 3.1).
// Let cost(n, p) be the least cost of the wide nodes in the subtree of n, if it may take p places of its
// parent:
// - p = 1: n becomes a wide node, and its two halves share kTreeWidth places below it;
// - p > 1: the halves share the p places, or the subtree uses fewer.
// Each inner node takes kTreeWidth^2 / 2 steps at most.

#include "engine/tree/collapse.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/tolerances.hpp"

namespace lrb {
namespace {

/// Returns what a wide node costs. The power is measured (docs/measurements.md).
double wide_cost(const BinaryNode& n) {
  return n.cost * std::sqrt(n.cost) + kSimplexCost * (n.end - n.begin);
}

}  // namespace

Collapse::Collapse(std::span<const BinaryNode> tree) : tree_(tree), best_(tree.size()) {
  // Children come after parents: reverse order is from the leaves upwards. Leaves keep cost 0.
  for (std::size_t node = tree.size(); node-- > 0;) {
    if (tree[node].is_leaf()) continue;
    Best& best = best_[node];
    const Best &left = best_[tree[node].left], &right = best_[tree[node].right];
    for (std::uint32_t places = 2; places <= kTreeWidth; ++places) {
      // The best distribution of the places over both halves; of equal ones, the fewest places on the left.
      std::uint32_t to_left = 1;
      const auto cost = [&](std::uint32_t k) { return left.cost[k - 1] + right.cost[places - k - 1]; };
      for (std::uint32_t k = 2; k < places; ++k)
        if (cost(k) < cost(to_left)) to_left = k;
      best.to_left[places - 1] = static_cast<std::uint8_t>(to_left);
      best.cost[places - 1] = cost(to_left);
    }
    // One place: the node itself becomes wide, and its halves share all of its places.
    best.cost[0] = wide_cost(tree[node]) + best.cost[kTreeWidth - 1];
    // More places never cost more, because a subtree may leave some unused.
    for (std::uint32_t places = 2; places <= kTreeWidth; ++places)
      best.cost[places - 1] = std::min(best.cost[places - 1], best.cost[places - 2]);
  }
}

std::vector<std::uint32_t> Collapse::children(std::uint32_t node) const {
  std::vector<std::uint32_t> children;
  share(node, kTreeWidth, children);
  return children;
}

/// Shares places among the children of a node that does not become a wide one by itself.
void Collapse::share(std::uint32_t node, std::uint32_t places, std::vector<std::uint32_t>& children) const {
  const std::uint32_t to_left = best_[node].to_left[places - 1];
  const auto give = [&](std::uint32_t child, std::uint32_t given) {
    const auto& cost = best_[child].cost;
    // Equal cost with fewer places: give the rest up. share() must not follow a distribution that lost.
    while (given > 1 && cost[given - 1] == cost[given - 2]) --given;
    // One place left: the child is a wide node (or a leaf). More: its own children take its places.
    given == 1 ? children.push_back(child) : share(child, given, children);
  };
  give(tree_[node].left, to_left);
  give(tree_[node].right, places - to_left);
}

}  // namespace lrb
