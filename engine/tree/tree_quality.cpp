#include "engine/tree/tree_quality.hpp"

namespace lrb {
namespace {

bool children_overlap(const TreeNode& n, int x, int y) {
  // Codes on the parent's axes. Boxes that only touch do not count.
  for (int axis = 0; axis < 3; ++axis)
    if (n.lo[axis][x] >= n.hi[axis][y] || n.lo[axis][y] >= n.hi[axis][x]) return false;
  return true;
}

/// Returns the surface area of a node's box, tree units squared.
double area_of(const TreeNode& n) {
  double side[3];
  for (int i = 0; i < 3; ++i) side[i] = static_cast<double>(n.scale[i]) * kQuantizedMost;
  return 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
}

}  // namespace

TreeQuality tree_quality(const ObbTree& tree) {
  TreeQuality q;
  if (tree.empty()) return q;
  q.height = tree.height();
  std::uint64_t children = 0, pairs = 0, overlapping = 0;
  // A random line that hits the root hits a node with probability area / root area (Goldsmith and Salmon
  // 1987).
  const double root = area_of(tree.nodes()[0]);
  for (const TreeNode& n : tree.nodes()) {
    const double share = root > 0 ? area_of(n) / root : 0;
    ++q.nodes;
    if (n.is_leaf) {
      ++q.leaves;
      q.simplices += n.count;
      q.sah_leaves += share;
      continue;
    }
    q.sah_inner += share;
    children += n.count;
    // At most 28 pairs of siblings per node.
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
