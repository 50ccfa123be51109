#pragma once
/// Which nodes of a binary tree become children of which wide ones.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/tree/binary_tree.hpp"
#include "engine/tree/obb_tree.hpp"

namespace lrb {

/// Collapses a binary tree to nodes of up to kTreeWidth children so that the sum of all wide nodes' costs is
/// least. What a node costs is about how often it is visited: BinaryNode::cost to the power of 1.5.
///
/// Source: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
/// BVHs", 2017, section 3.1 (dynamic programming, from the leaves upward), where it is the surface itself.
class Collapse {
 public:
  /// `tree` must outlive this.
  explicit Collapse(std::span<const BinaryNode> tree);

  /// Returns the children of the wide node that an inner node becomes: 2 to kTreeWidth, in the tree's order.
  std::vector<std::uint32_t> children(std::uint32_t node) const;

 private:
  /// What is best for a subtree, where it may take the place of 1 to kTreeWidth children of a wide node.
  struct Best {
    std::array<double, kTreeWidth> cost{};           ///< [places - 1]: of all wide nodes in it
    std::array<std::uint8_t, kTreeWidth> to_left{};  ///< [places - 1]: places that its left half takes
  };

  void share(std::uint32_t node, std::uint32_t places, std::vector<std::uint32_t>& children) const;

  std::span<const BinaryNode> tree_;
  std::vector<Best> best_;  ///< for each node; 0 for a leaf, which costs the same in every tree
};

}  // namespace lrb
