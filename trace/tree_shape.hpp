#pragma once
/// The shape of a tree over a body's simplices, ours or another engine's: all that is needed to say where
/// work went.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb::trace {

/// A box in the body's frame, mesh's unit.
struct ShapeBox {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> half;  ///< from the centre to the middle of a side

  double area() const;
};

class TreeShape {
 public:
  TreeShape() = default;
  /// The shape of one of our trees.
  explicit TreeShape(const ObbTree& tree);

  /// Adds a node, the root first; its number is that of nodes before it. Leaves have simplices, all others
  /// children, which may be added later.
  void add(std::span<const std::uint32_t> children, std::span<const SimplexId> simplices,
           const ShapeBox& box);
  /// Finds depths and what lies beneath, when all nodes are there. Throws std::invalid_argument if they are
  /// no tree.
  void finish();

  std::size_t size() const { return boxes_.size(); }
  bool is_leaf(std::uint32_t node) const { return children(node).empty(); }
  std::span<const std::uint32_t> children(std::uint32_t node) const {
    return {children_.data() + first_child_[node], children_.data() + first_child_[node + 1]};
  }
  std::span<const SimplexId> simplices(std::uint32_t node) const {
    return {simplices_.data() + first_simplex_[node], simplices_.data() + first_simplex_[node + 1]};
  }
  const ShapeBox& box(std::uint32_t node) const { return boxes_[node]; }
  std::uint32_t depth(std::uint32_t node) const { return depth_[node]; }  ///< 0: the root
  /// Returns the number of simplices beneath a node.
  std::uint32_t beneath(std::uint32_t node) const { return beneath_[node]; }
  /// Returns the nodes, parents before children.
  const std::vector<std::uint32_t>& from_root() const { return order_; }

 private:
  std::vector<std::uint32_t> first_child_ = {0}, first_simplex_ = {0};
  std::vector<std::uint32_t> children_;
  std::vector<SimplexId> simplices_;
  std::vector<ShapeBox> boxes_;
  std::vector<std::uint32_t> depth_, beneath_, order_;
};

}  // namespace lrb::trace
