// How a binary tree becomes one of wide nodes, against all ways in which it can.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "engine/core/geometry.hpp"
#include "engine/tree/binary_tree.hpp"
#include "scenarios/bodies/shapes.hpp"

using namespace lrb;
using shapes::RandomEngine;

namespace {

/// Appends a binary tree with `leaves` leaves of eight simplices each. split: returns how many of some leaves
/// go to the left; cost: the cost of the next node.
void add_tree(std::vector<BinaryNode>& tree, std::uint32_t leaves,
              const std::function<std::uint32_t(std::uint32_t)>& split, const std::function<double()>& cost,
              std::uint32_t first = 0) {
  const auto self = static_cast<std::uint32_t>(tree.size());
  tree.emplace_back().cost = cost();
  tree[self].begin = first * kTreeWidth;
  tree[self].end = (first + leaves) * kTreeWidth;
  if (leaves == 1) return;
  const std::uint32_t of_left = split(leaves);
  tree[self].left = self + 1;
  add_tree(tree, of_left, split, cost, first);
  tree[self].right = static_cast<std::uint32_t>(tree.size());
  add_tree(tree, leaves - of_left, split, cost, first + of_left);
}

double wide_cost(const BinaryNode& n) {
  return std::pow(n.cost, 1.5);
}

/// The least cost of all wide nodes in subtrees, found by looking at all ways to choose children.
class LeastCosts {
 public:
  explicit LeastCosts(const std::vector<BinaryNode>& tree) : tree_(tree), of_(tree.size()) {
    for (std::size_t n = tree.size(); n-- > 0;) find(static_cast<std::uint32_t>(n));
  }
  double of_root() const { return of_[0].at(1); }

 private:
  /// For each number of children that can take a subtree's place: what these cost.
  using ByNumber = std::map<std::uint32_t, double>;

  void find(std::uint32_t n) {
    of_[n][1] = 0;
    if (tree_[n].is_leaf()) return;
    double least = kInfinity;
    ByNumber replaced;
    for (const auto& [x, cost_x] : of_[tree_[n].left])
      for (const auto& [y, cost_y] : of_[tree_[n].right]) {
        if (x + y > kTreeWidth) continue;
        least = std::min(least, cost_x + cost_y);
        const auto known = replaced.try_emplace(x + y, kInfinity).first;
        known->second = std::min(known->second, cost_x + cost_y);
      }
    of_[n] = replaced;
    of_[n][1] = wide_cost(tree_[n]) + least;
  }

  const std::vector<BinaryNode>& tree_;
  std::vector<ByNumber> of_;
};

struct WideTree {
  double cost = 0;
  std::uint32_t height = 1;
  std::vector<std::uint32_t> leaves;  ///< from left to right
};

WideTree wide_tree(const std::vector<BinaryNode>& tree, const Collapse& collapse, std::uint32_t node) {
  WideTree wide;
  if (tree[node].is_leaf()) {
    wide.leaves = {node};
    return wide;
  }
  wide.cost = wide_cost(tree[node]);
  const std::vector<std::uint32_t> children = collapse.children(node);
  CHECK(children.size() >= 2);
  CHECK(children.size() <= kTreeWidth);
  for (const std::uint32_t child : children) {
    const WideTree below = wide_tree(tree, collapse, child);
    wide.cost += below.cost;
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

TEST_CASE("a binary tree is collapsed to wide nodes of minimum total cost") {
  RandomEngine random(1);
  const auto anywhere = [&](std::uint32_t leaves) {
    return static_cast<std::uint32_t>(shapes::uniform(random, 1, std::nextafter(1.0 * leaves, 0.0)));
  };
  for (int round = 0; round < 300; ++round) {
    const auto leaves = static_cast<std::uint32_t>(2 + round % 99);
    std::vector<BinaryNode> tree;
    // Costs of different sizes, some of them alike.
    add_tree(tree, leaves, anywhere, [&] {
      return round % 3 == 0 ? 1 : std::round(8 * std::pow(10, shapes::uniform(random, 0, 2))) / 8;
    });
    CAPTURE(leaves);
    for (const double size : {1.0, 1e-3}) {  // boxes of the body's size, and small ones
      for (BinaryNode& n : tree) n.cost *= size;
      const Collapse collapse(tree);
      const WideTree wide = wide_tree(tree, collapse, 0);
      CHECK(wide.cost == doctest::Approx(LeastCosts(tree).of_root()).epsilon(1e-5));
      CHECK(wide.leaves == leaves_of(tree));
    }
  }
}

TEST_CASE("trees of nodes without extent have low depth") {
  const auto halve = [](std::uint32_t leaves) { return leaves / 2; };
  const auto nothing = [] { return 0.0; };
  for (const auto& [leaves, height] : {std::pair{8u, 2u},
                                       {9u, 3u},
                                       {64u, 3u},
                                       {65u, 4u},
                                       {100u, 4u},
                                       {512u, 4u},
                                       {625u, 5u},
                                       {1000u, 5u},
                                       {4096u, 5u},
                                       {5000u, 6u}}) {
    std::vector<BinaryNode> tree;
    add_tree(tree, leaves, halve, nothing);
    CHECK(wide_tree(tree, Collapse(tree), 0).height == height);
  }
}
