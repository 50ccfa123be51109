#pragma once
/// The 8-wide OBB tree that the complete query walks: leaves are blocks of real simplices, nodes hold bounds.
///
/// Invariant: the bounds of a node contain all real simplices beneath it. This alone makes the query complete
/// (see tree_query.hpp). The shape of the tree is free: it follows a surface area heuristic, not the nesting
/// of regions, and a block may hold simplices of several regions, which keeps blocks full. Which regions a
/// wrapper must have refined to show a simplex is looked up from its face (LrbRep::outer_cell) when it is
/// first compared.
///
/// Coordinates are kept in *units*: multiples of a power of two near the body's size, so that float boxes
/// neither overflow nor underflow at any scale of input.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/ids.hpp>

namespace lrb {

struct SimplexView;  // no Eigen here: the kernels are compiled for processors that its headers refuse

inline constexpr std::uint32_t kTreeWidth = 8;  ///< children of a node, simplices of a block
inline constexpr int kQuantizedMost = 255;      ///< end of a node's box on its quantized axes

/// A node, inner or leaf: an oriented frame and up to eight boxes in it (those of its children, or of its
/// simplices). A point x (units, body axes) has node coordinates frame * (x - origin). On axis i, box k spans
/// base[i] + scale[i] * [lo[i][k], hi[i][k]]; it is quantized outward.
struct alignas(64) TreeNode {
  float frame[3][3];  ///< rows: the node's axes, unit length to float precision
  float base[3], scale[3];
  double origin[3];                                   ///< units, body axes
  std::uint8_t lo[3][kTreeWidth], hi[3][kTreeWidth];  ///< lo 255, hi 0 for absent children
  std::uint32_t
      first;  ///< inner: index of the first child (children are contiguous); leaf: index of its block
  std::uint8_t count;  ///< number of children or simplices
  std::uint8_t is_leaf;
  std::uint8_t padding[2];
  float radius;  ///< radius of a ball about the origin that holds everything beneath, units
};
static_assert(sizeof(TreeNode) == 192);

/// The simplices of a leaf: corners in the leaf's coordinates, eight simplices side by side. A segment
/// repeats its second corner.
struct alignas(64) LeafBlock {
  float corner[3][3][kTreeWidth];  ///< [corner][axis][simplex]; absent simplices repeat the last one
  SimplexId simplex[kTreeWidth];   ///< kNull where absent
};
static_assert(sizeof(LeafBlock) == 320);

class ObbTree {
 public:
  ObbTree() = default;
  /// Builds the tree over a body's real simplices. The tree is the same for any number of threads.
  explicit ObbTree(const SimplexView& body, unsigned threads = 1);
  /// Builds the tree over the listed simplices, real or pseudo: then "real" above means these.
  ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, unsigned threads = 1);
  /// Takes a tree as it was stored. Throws InputError unless it can be walked safely and its leaves hold
  /// every real simplex once. Assumes that its bounds are right: bounds_hold() tells.
  ObbTree(const SimplexView& body, std::vector<TreeNode> nodes, std::vector<LeafBlock> blocks);
  /// Does the same with a tree over the listed simplices.
  ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, std::vector<TreeNode> nodes,
          std::vector<LeafBlock> blocks);

  /// Returns true if every node's boxes hold what lies beneath: the query's completeness rests on this.
  bool bounds_hold(const SimplexView& body) const;

  bool empty() const { return nodes_.empty(); }
  const std::vector<TreeNode>& nodes() const { return nodes_; }  ///< the root is node 0
  const std::vector<LeafBlock>& blocks() const { return blocks_; }
  double unit() const { return unit_; }      ///< a power of two; coordinates / unit are in units
  double extent() const { return extent_; }  ///< largest absolute coordinate of a corner, mesh's unit
  std::uint32_t height() const { return height_; }
  std::size_t memory_bytes() const {
    return nodes_.capacity() * sizeof(TreeNode) + blocks_.capacity() * sizeof(LeafBlock);
  }

 private:
  friend class ObbTreeBuilder;
  void measure(const SimplexView& body, std::span<const SimplexId> simplices);  ///< sets unit and extent

  std::vector<TreeNode> nodes_;
  std::vector<LeafBlock> blocks_;
  double unit_ = 1;
  double extent_ = 0;
  std::uint32_t height_ = 0;
};

// Measures a tree's quality from its shape, without running a query.

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
