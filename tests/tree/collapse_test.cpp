// How a binary tree becomes one of wide nodes, against all ways in which it can.
#include "engine/tree/collapse.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "engine/core/infinity.hpp"
#include "scenarios/bodies/shapes/random_pose.hpp"
#include "scenarios/bodies/shapes/shapes.hpp"

using namespace lrb;
using shapes::RandomEngine;

namespace {

/// Appends a random binary tree with so many leaves, whose nodes cost what `cost` returns. Returns its root.
std::uint32_t add_tree(std::vector<BinaryNode>& tree, std::uint32_t leaves, RandomEngine& random,
                       const std::function<double()>& cost) {
  const auto self = static_cast<std::uint32_t>(tree.size());
  tree.emplace_back().cost = cost();
  if (leaves == 1) return self;
  const auto of_left =
      static_cast<std::uint32_t>(shapes::uniform(random, 1, std::nextafter(1.0 * leaves, 0.0)));
  const std::uint32_t left = add_tree(tree, of_left, random, cost);
  const std::uint32_t right = add_tree(tree, leaves - of_left, random, cost);
  tree[self].left = left;
  tree[self].right = right;
  return self;
}

double wide_cost(const BinaryNode& n) {
  return std::pow(n.cost, 1.5);
}

/// What a set of children costs: of all sets with the same number of them, the least.
using LeastCosts = std::map<std::uint32_t, double>;

/// Returns the least cost of all wide nodes in a subtree that has its place as one child, by looking at all
/// ways to choose children.
double least_cost(const std::vector<BinaryNode>& tree, std::uint32_t node) {
  // All sets of subtrees that a node can be replaced by.
  const std::function<LeastCosts(std::uint32_t)> open = [&](std::uint32_t n) {
    LeastCosts all;
    all[1] = least_cost(tree, n);
    if (tree[n].is_leaf()) return all;
    for (const auto& [x, cost_x] : open(tree[n].left))
      for (const auto& [y, cost_y] : open(tree[n].right)) {
        if (x + y > kTreeWidth) continue;
        const auto known = all.try_emplace(x + y, kInfinity).first;
        known->second = std::min(known->second, cost_x + cost_y);
      }
    return all;
  };
  if (tree[node].is_leaf()) return 0;
  double least = kInfinity;
  for (const auto& [x, cost_x] : open(tree[node].left))
    for (const auto& [y, cost_y] : open(tree[node].right))
      if (x + y <= kTreeWidth) least = std::min(least, cost_x + cost_y);
  return wide_cost(tree[node]) + least;
}

struct WideTree {
  double cost = 0;
  std::uint32_t nodes = 0, height = 1;
  std::vector<std::uint32_t> leaves;  ///< from left to right
};

WideTree wide_tree(const std::vector<BinaryNode>& tree, const Collapse& collapse, std::uint32_t node) {
  WideTree wide;
  if (tree[node].is_leaf()) {
    wide.leaves = {node};
    return wide;
  }
  wide.cost = wide_cost(tree[node]);
  wide.nodes = 1;
  const std::vector<std::uint32_t> children = collapse.children(node);
  CHECK(children.size() >= 2);
  CHECK(children.size() <= kTreeWidth);
  for (const std::uint32_t child : children) {
    const WideTree below = wide_tree(tree, collapse, child);
    wide.cost += below.cost;
    wide.nodes += below.nodes;
    wide.height = std::max(wide.height, 1 + below.height);
    wide.leaves.insert(wide.leaves.end(), below.leaves.begin(), below.leaves.end());
  }
  return wide;
}

std::vector<std::uint32_t> leaves_of(const std::vector<BinaryNode>& tree) {
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t n = 0; n < tree.size(); ++n)
    if (tree[n].is_leaf()) leaves.push_back(n);
  return leaves;  // parents come before children, left before right
}

}  // namespace

TEST_CASE("a binary tree is collapsed to the wide nodes that cost least in all") {
  RandomEngine random(1);
  for (int round = 0; round < 60; ++round) {
    const auto leaves = static_cast<std::uint32_t>(2 + round % 20);
    std::vector<BinaryNode> tree;
    // Costs of different sizes, some of them alike.
    add_tree(tree, leaves, random, [&] {
      return round % 3 == 0 ? 1 : std::round(8 * std::pow(10, shapes::uniform(random, 0, 2))) / 8;
    });
    const Collapse collapse(tree);
    const WideTree wide = wide_tree(tree, collapse, 0);
    CAPTURE(leaves);
    CHECK(wide.cost == doctest::Approx(least_cost(tree, 0)).epsilon(1e-9));
    CHECK(wide.leaves == leaves_of(tree));
  }
}

TEST_CASE("nodes without any size are collapsed to few wide ones, evenly") {
  RandomEngine random(2);
  for (const std::uint32_t leaves : {8u, 64u, 512u}) {
    std::vector<BinaryNode> tree;
    const std::function<std::uint32_t(std::uint32_t)> halve = [&](std::uint32_t n) {
      const auto self = static_cast<std::uint32_t>(tree.size());
      tree.emplace_back();
      if (n == 1) return self;
      const std::uint32_t left = halve(n / 2), right = halve(n - n / 2);
      tree[self].left = left;
      tree[self].right = right;
      return self;
    };
    halve(leaves);
    const WideTree wide = wide_tree(tree, Collapse(tree), 0);
    CAPTURE(leaves);
    CHECK(wide.nodes == (leaves - 1) / 7);
    CHECK(wide.height == (leaves == 8 ? 2 : leaves == 64 ? 3 : 4));
  }
}
