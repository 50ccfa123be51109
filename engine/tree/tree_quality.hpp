#pragma once
/// Measures a tree's quality from its shape, without running a query.

#include <cstdint>

#include "engine/tree/obb_tree.hpp"

namespace lrb {

struct TreeQuality {
  std::uint32_t nodes = 0, leaves = 0, simplices = 0, height = 0;
  double sah_inner =
      0;  ///< sum of inner nodes' areas / the root's: the inner nodes that a random line visits
  double sah_leaves = 0;  ///< the same of leaves
  double child_fill = 0;  ///< children / (inner nodes x 8); best 1
  double leaf_fill = 0;   ///< simplices / (leaves x 8); best 1
  /// Share of pairs of siblings whose boxes overlap, as the parent holds them, on its axes; best near 0.
  double sibling_overlap = 0;
  double bytes_per_simplex = 0;
};
/// Returns the figures of a tree; all 0 for an empty one. Source of the cost: Goldsmith and Salmon, Automatic
/// Creation of Object Hierarchies for Ray Tracing, 1987.
TreeQuality tree_quality(const ObbTree& tree);

}  // namespace lrb
