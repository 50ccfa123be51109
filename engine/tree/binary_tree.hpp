#pragma once
/// The binary tree over simplices that is collapsed to the 8-wide OBB tree.

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
  double cost = 0;          ///< box_cost() of the tight box, or of `box` for ranges that are not fitted
  bool is_leaf() const { return left == kNull; }
};

/// The effort of choosing splits.
struct Splits {
  /// Ranges of at most this many simplices are split by the tight boxes of their halves, larger ones by boxes
  /// on the coordinate axes.
  std::uint32_t fitted;
  CutEffort effort;  ///< for these small ranges
  bool all_cuts;     ///< for larger ranges: choose from all cuts instead of bin boundaries
};

/// Builds the tree top-down and sorts Soup::order. Every split has a multiple of kTreeWidth simplices on its
/// left, so that all leaves except the last are full; the surface area heuristic chooses among those splits.
/// Parents come before children, left before right. The result does not depend on the number of threads.
std::vector<BinaryNode> build_binary_tree(Soup& soup, Workers& workers, Splits splits);

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
