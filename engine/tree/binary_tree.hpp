#pragma once
/// The binary tree over simplices that becomes an OBB tree when it is collapsed to width eight.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/tree/fitted_cut.hpp"
#include <lrbscope/ids.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

struct BinaryNode {
  std::uint32_t begin, end;  ///< range in Soup::order
  std::uint32_t left = kNull, right = kNull;
  Eigen::AlignedBox3d box;  ///< on the coordinate axes
  double cost = 0;          ///< box_cost() of the box that fits, or of `box` where cuts are not fitted
  bool is_leaf() const { return left == kNull; }
};

/// How much is spent on choosing splits.
struct Splits {
  /// Ranges of at most so many simplices are split so that the boxes that fit their halves are small; larger
  /// ones by boxes on the coordinate axes.
  std::uint32_t fitted;
  CutEffort effort;  ///< for these
  bool all_cuts;     ///< of larger ranges: chooses from all cuts, in place of those between bins
};

/// Builds the tree top-down, and puts the simplices in order. Every split leaves a multiple of kTreeWidth
/// simplices on its left, so that all leaves but the last are full; among those splits a surface area
/// heuristic chooses. Parents come before children, left before right. The same for any number of threads.
std::vector<BinaryNode> build_binary_tree(Soup& soup, Workers& workers, Splits splits);

// Which nodes of a binary tree become children of which wide ones.

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
