#pragma once
/// The boxes of a tree's nodes, for looking at.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/obb_tree.hpp>

namespace lrb::run {

struct TreeBox {
  std::uint32_t node = 0;   ///< index into ObbTree::nodes()
  std::uint32_t depth = 0;  ///< 0: the root
  Eigen::Vector3d centre;   ///< body frame
  Eigen::Matrix3d half;     ///< columns: from the centre to the middles of three sides
};

/// Returns the boxes of all nodes down to the greatest depth at which they are no more than `most`, by depth.
std::vector<TreeBox> tree_boxes(const ObbTree& tree, std::size_t most);

/// Returns how many nodes there are at each depth, from the root's on.
std::vector<std::uint32_t> nodes_by_depth(const ObbTree& tree);

/// Returns the boxes of nodes below a depth that lie on the ways from the root to some simplices, in the
/// order of these, no more than `most`.
std::vector<TreeBox> boxes_on_ways(const ObbTree& tree, std::uint32_t below, const std::vector<SimplexId>& to,
                                   std::size_t most);

}  // namespace lrb::run
