#pragma once
/// The binary tree over simplices that becomes an OBB tree when it is collapsed to width eight.

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "engine/core/ids.hpp"
#include "engine/core/parallel.hpp"
#include "engine/tree/fitted_cut.hpp"
#include "engine/tree/soup.hpp"

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

}  // namespace lrb
