// Checks a tree that comes from a file.
// 1. check_structure(): every node but the root has exactly one parent, which comes before it. The nodes then
// form a tree and every traversal ends. Every simplex is in exactly one leaf.
// 2. bounds_hold(): each corner is in the box of its simplex and in those of all ancestors, and the leaf
// has a correct copy of it. This is what the query's completeness rests on.
#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/obb_tree.hpp"
#include "engine/tree/pose_bounds.hpp"
#include "engine/tree/simplex_view.hpp"

namespace lrb {
namespace {

[[noreturn]] void refuse(std::size_t node, const char* what) {
  throw InputError("node " + std::to_string(node) + " of the tree " + what +
                   "; build the LRB-rep again from its mesh");
}

/// Checks a leaf and removes its simplices from `missing`.
void check_leaf(std::size_t i, const TreeNode& node, const std::vector<LeafBlock>& blocks,
                std::vector<bool>& block_seen, std::vector<bool>& missing) {
  // A block belongs to exactly one leaf.
  if (node.first >= blocks.size() || block_seen[node.first]) refuse(i, "has no block of its own");
  block_seen[node.first] = true;
  for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
    const std::uint32_t s = blocks[node.first].simplex[k];
    // Absent simplices must be marked as such.
    if (k >= node.count) {
      if (s != kNull) refuse(i, "has a block with more faces than it counts");
      continue;
    }
    if (s >= missing.size() || !missing[s])
      refuse(i, "holds a face that is not the tree's or is in another leaf, too");
    missing[s] = false;
  }
}

/// Checks that everything is reached once from the root, and that children come after their parents.
void check_structure(const std::vector<TreeNode>& nodes, const std::vector<LeafBlock>& blocks,
                     std::span<const SimplexId> simplices) {
  // `missing` starts as the set of listed simplices; leaves remove theirs.
  std::vector<bool> node_seen(nodes.size(), false), block_seen(blocks.size(), false);
  std::vector<bool> missing(
      simplices.empty() ? 0 : *std::max_element(simplices.begin(), simplices.end()) + std::size_t{1}, false);
  for (const SimplexId s : simplices) missing[s] = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const TreeNode& node = nodes[i];
    // Parents come before children, so one pass in ascending order reaches every node after its parent.
    if (i > 0 && !node_seen[i]) refuse(i, "has no parent before it");
    if (node.count == 0 || node.count > kTreeWidth) refuse(i, "has no children, or too many");
    if (node.is_leaf > 1) refuse(i, "is neither leaf nor inner");
    if (node.is_leaf != 0) {
      check_leaf(i, node, blocks, block_seen, missing);
      continue;
    }
    // Written without a sum that could overflow.
    if (node.first <= i || node.first > nodes.size() || node.count > nodes.size() - node.first)
      refuse(i, "has children that do not exist");
    for (std::uint32_t k = 0; k < node.count; ++k) {
      if (node_seen[node.first + k]) refuse(i, "has a child of another node");
      node_seen[node.first + k] = true;
    }
  }
  // Nothing may be left over: no simplex and no block.
  if (std::find(missing.begin(), missing.end(), true) != missing.end() ||
      std::find(block_seen.begin(), block_seen.end(), false) != block_seen.end())
    refuse(0, "does not hold all faces");
}

Eigen::Vector3d in_frame(const TreeNode& node, const Eigen::Vector3d& x) {
  Eigen::Vector3d out;
  for (int i = 0; i < 3; ++i) {
    out[i] = 0;
    for (int j = 0; j < 3; ++j) out[i] += static_cast<double>(node.frame[i][j]) * (x[j] - node.origin[j]);
  }
  return out;
}

/// Returns true if box `k` of a node and its ball contain a point in units.
bool holds(const TreeNode& node, std::uint32_t k, const Eigen::Vector3d& x) {
  // The codes are decoded in double. Comparisons with NaN are false, so damaged numbers fail.
  const Eigen::Vector3d at = in_frame(node, x);
  for (int i = 0; i < 3; ++i) {
    const double base = node.base[i], scale = node.scale[i];
    if (!(at[i] >= base + scale * node.lo[i][k] && at[i] <= base + scale * node.hi[i][k])) return false;
  }
  return at.norm() <= node.radius;
}

/// Returns true if a leaf's copy of a corner is the corner, to the rounding that the query allows for.
bool is_copy(const TreeNode& leaf, const LeafBlock& block, std::uint32_t k, int corner,
             const Eigen::Vector3d& x) {
  const Eigen::Vector3d at = in_frame(leaf, x);
  // The kernel's error bounds assume no larger error in the copies.
  const double rounding = kTreeRounding * leaf.radius + kTreeRoundingUnits;
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(at[i] - static_cast<double>(block.corner[corner][i][k])) <= rounding)) return false;
  return true;
}

bool is_orthonormal(const TreeNode& node) {
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) axes(i, j) = static_cast<double>(node.frame[i][j]);
  return rotation_defect(axes.transpose()) <= kFrameDefect;
}

}  // namespace

ObbTree::ObbTree(const SimplexView& body, std::vector<TreeNode> nodes, std::vector<LeafBlock> blocks)
    : ObbTree(body, body.real_simplices(), std::move(nodes), std::move(blocks)) {}

ObbTree::ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, std::vector<TreeNode> nodes,
                 std::vector<LeafBlock> blocks)
    : nodes_(std::move(nodes)), blocks_(std::move(blocks)) {
  measure(body, simplices);
  check_structure(nodes_, blocks_, simplices);
  // Heights from the root downwards, in one pass, because parents come first.
  std::vector<std::uint32_t> height(nodes_.size(), 1);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    height_ = std::max(height_, height[i]);
    for (std::uint32_t k = 0; nodes_[i].is_leaf == 0 && k < nodes_[i].count; ++k)
      height[nodes_[i].first + k] = height[i] + 1;
  }
}

bool ObbTree::bounds_hold(const SimplexView& body) const {
  int exponent = 0;
  std::frexp(unit_, &exponent);
  // Record each node's parent and its place there on the way down.
  std::vector<std::uint32_t> parent(nodes_.size(), kNull), place(nodes_.size(), 0);
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const TreeNode& node = nodes_[i];
    if (!is_orthonormal(node)) return false;
    if (node.is_leaf == 0) {
      for (std::uint32_t k = 0; k < node.count; ++k) {
        parent[node.first + k] = i;
        place[node.first + k] = k;
      }
      continue;
    }
    for (std::uint32_t k = 0; k < node.count; ++k) {
      VertexId v[3];
      body.simplex(blocks_[node.first].simplex[k], v);
      for (int corner = 0; corner < body.dim; ++corner) {
        const Eigen::Vector3d& world = body.vertices[v[corner]];
        // The same scaling as in Soup: a power of two, exact but for underflow.
        const Eigen::Vector3d x(std::ldexp(world.x(), 1 - exponent), std::ldexp(world.y(), 1 - exponent),
                                std::ldexp(world.z(), 1 - exponent));
        if (!holds(node, k, x) || !is_copy(node, blocks_[node.first], k, corner, x)) return false;
        // Climb to the root: one test per ancestor, so the time is the number of corners times the height.
        for (std::uint32_t n = i; parent[n] != kNull; n = parent[n])
          if (!holds(nodes_[parent[n]], place[n], x)) return false;
      }
    }
  }
  return true;
}

}  // namespace lrb
