#pragma once
/// The binary tree over simplices that is collapsed to the 8-wide OBB tree.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/tree/build_kernel.hpp"
#include <lrbscope/ids.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

/// Number of simplices to be distributed to a thread at once.
inline constexpr std::size_t kShare = 4096;
inline std::size_t shares_of(std::size_t n) {
  return (n + kShare - 1) / kShare;
}

/// Calls work(begin, end, share) for the ranges of kShare numbers that [0, n) consists of.
template <class Work>
void for_each_share(std::size_t n, Workers& workers, const Work& work) {
  workers.for_each(shares_of(n), [&](std::size_t share, unsigned) {
    work(static_cast<std::uint32_t>(share * kShare),
         static_cast<std::uint32_t>(std::min(n, (share + 1) * kShare)), share);
  });
}

/// Returns the number of leaves for some simplices; all except the last are full.
inline std::uint32_t leaves_for(std::uint32_t simplices) {
  return (simplices + kTreeWidth - 1) / kTreeWidth;
}
/// Returns the number of nodes of a binary tree with this many simplices.
inline std::uint32_t nodes_for(std::uint32_t simplices) {
  return 2 * leaves_for(simplices) - 1;
}

/// A binary tree in preorder: parents come before children, left before right. Every split has a multiple of
/// kTreeWidth simplices on its left, so that all leaves except the last are full; the surface area heuristic
/// chooses among those splits. The result does not depend on the number of threads.
struct BinaryTree {
  std::vector<BinaryNode> nodes;
  std::vector<std::uint32_t> order;  ///< indices of simplices; ranges of nodes refer to it
};

/// Returns a tree whose leaves are ranges of at most kSmallRange simplices, which run_divide_kernel()
/// divides. Its nodes are in the places that they have in the divided tree; the others are empty.
BinaryTree split_large_ranges(const BuildInput& in, std::uint32_t count, Workers& workers);

// Collapse of a binary tree to a wide one.

/// Collapses a binary tree to nodes of up to kTreeWidth children with minimum total cost of all wide nodes.
/// The cost of a node estimates how often it is visited: BinaryNode::cost^1.5.
///
/// Source: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
/// BVHs", 2017, section 3.1 (bottom-up dynamic programming; there the cost is the surface area itself).
class Collapse {
 public:
  /// `tree` must outlive this object.
  explicit Collapse(std::span<const BinaryNode> tree);

  /// Returns the children of the wide node for an inner node: 2 to kTreeWidth, in the tree's order.
  std::vector<std::uint32_t> children(std::uint32_t node) const;

 private:
  /// The optimum for a subtree that may use 1 to kTreeWidth child slots of a wide node.
  struct Best {
    std::array<double, kTreeWidth> cost{};           ///< [slots - 1]: total cost of all wide nodes in it
    std::array<std::uint8_t, kTreeWidth> to_left{};  ///< [slots - 1]: slots used by its left half
  };

  void share(std::uint32_t node, std::uint32_t places, std::vector<std::uint32_t>& children) const;

  std::span<const BinaryNode> tree_;
  std::vector<Best> best_;  ///< for each node; 0 for a leaf, which costs the same in every tree
};

}  // namespace lrb
