#include "engine/tree/tree_quality.hpp"

#include <algorithm>

namespace lrb {
namespace {

/// Returns the nodes in an order in which parents come before their children.
std::vector<std::uint32_t> from_the_root(const ObbTree& tree) {
  std::vector<std::uint32_t> order;
  if (!tree.empty()) order.push_back(0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const TreeNode& n = tree.nodes()[order[i]];
    for (std::uint32_t k = 0; !n.is_leaf && k < n.count; ++k) order.push_back(n.first + k);
  }
  return order;
}

bool children_overlap(const TreeNode& n, int x, int y) {
  for (int axis = 0; axis < 3; ++axis)
    if (n.lo[axis][x] >= n.hi[axis][y] || n.lo[axis][y] >= n.hi[axis][x]) return false;
  return true;
}

}  // namespace

std::vector<std::uint32_t> node_depths(const ObbTree& tree) {
  std::vector<std::uint32_t> depth(tree.nodes().size(), 0);
  for (const std::uint32_t i : from_the_root(tree)) {
    const TreeNode& n = tree.nodes()[i];
    for (std::uint32_t k = 0; !n.is_leaf && k < n.count; ++k) depth[n.first + k] = depth[i] + 1;
  }
  return depth;
}

std::vector<std::uint32_t> simplices_beneath(const ObbTree& tree) {
  std::vector<std::uint32_t> count(tree.nodes().size(), 0);
  std::vector<std::uint32_t> order = from_the_root(tree);
  std::reverse(order.begin(), order.end());
  for (const std::uint32_t i : order) {
    const TreeNode& n = tree.nodes()[i];
    if (n.is_leaf) count[i] = n.count;
    for (std::uint32_t k = 0; !n.is_leaf && k < n.count; ++k) count[i] += count[n.first + k];
  }
  return count;
}

double node_area(const ObbTree& tree, std::uint32_t node) {
  const TreeNode& n = tree.nodes()[node];
  double side[3];
  for (int i = 0; i < 3; ++i) side[i] = static_cast<double>(n.scale[i]) * kQuantizedMost;
  return 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
}

TreeQuality tree_quality(const ObbTree& tree) {
  TreeQuality q;
  if (tree.empty()) return q;
  q.height = tree.height();
  std::uint64_t children = 0, pairs = 0, overlapping = 0;
  const double root = node_area(tree, 0);
  for (const std::uint32_t i : from_the_root(tree)) {
    const TreeNode& n = tree.nodes()[i];
    const double share = root > 0 ? node_area(tree, i) / root : 0;
    ++q.nodes;
    if (n.is_leaf) {
      ++q.leaves;
      q.simplices += n.count;
      q.sah_leaves += share;
      continue;
    }
    q.sah_inner += share;
    children += n.count;
    for (int x = 0; x < n.count; ++x)
      for (int y = 0; y < x; ++y) {
        ++pairs;
        overlapping += children_overlap(n, x, y);
      }
  }
  const std::uint32_t inner = q.nodes - q.leaves;
  if (inner > 0) q.child_fill = static_cast<double>(children) / (inner * double{kTreeWidth});
  q.leaf_fill = static_cast<double>(q.simplices) / (q.leaves * double{kTreeWidth});
  if (pairs > 0) q.sibling_overlap = static_cast<double>(overlapping) / static_cast<double>(pairs);
  q.bytes_per_simplex = static_cast<double>(tree.memory_bytes()) / q.simplices;
  return q;
}

}  // namespace lrb
