#pragma once
/// The 8-wide OBB tree (Gottschalk, Lin and Manocha, "OBBTree", 1996) of the complete query. Leaves are
/// blocks of real simplices.
///
/// Invariant: the bounds of a node contain all real simplices beneath it. This alone makes the query complete
/// (proof in tree_query.hpp). The shape of the tree is independent of the nesting of regions. It follows the
/// surface area heuristic, and a block may contain simplices of several regions, which keeps blocks full. The
/// regions that must be refined to expose a simplex are looked up from its face (LrbRep::outer_cell) when it
/// is first compared.
///
/// Coordinates are stored in *units*: multiples of a power of two near the body's size, so that float boxes
/// neither overflow nor underflow at any scale of the input.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/ids.hpp>

namespace lrb {

struct SimplexView;  // no Eigen here: kernels are compiled for processors that Eigen's headers reject

inline constexpr std::uint32_t kTreeWidth = 8;  ///< children per node, simplices per block
inline constexpr int kQuantizedMost = 255;      ///< upper end of a node's quantized axes

/// An inner node or leaf: an oriented frame with up to eight boxes in it, one for each child or simplex. A
/// point x (units, body axes) has node coordinates frame * (x - origin). On axis i, box k spans base[i] +
/// scale[i] * [lo[i][k], hi[i][k]], quantized outward.
struct alignas(64) TreeNode {
  float frame[3][3];  ///< rows: the node's axes, unit length up to float precision
  float base[3], scale[3];
  double origin[3];                                   ///< units, body axes
  std::uint8_t lo[3][kTreeWidth], hi[3][kTreeWidth];  ///< lo 255, hi 0 for absent children
  /// Inner node: index of the first child (children are contiguous). Leaf: index of its block.
  std::uint32_t first;
  std::uint8_t count;  ///< number of children or simplices
  std::uint8_t is_leaf;
  std::uint8_t padding[2];
  float radius;  ///< radius of a ball about the origin that contains everything beneath, units
};
static_assert(sizeof(TreeNode) == 192);

/// The simplices of a leaf: corners in the leaf's coordinates, in structure-of-arrays layout. A segment
/// repeats its second corner.
struct alignas(64) LeafBlock {
  float corner[3][3][kTreeWidth];  ///< [corner][axis][simplex]; absent simplices repeat the last one
  SimplexId simplex[kTreeWidth];   ///< kNull where absent
};
static_assert(sizeof(LeafBlock) == 320);

class ObbTree {
 public:
  ObbTree() = default;
  /// Builds the tree over a body's real simplices. The result does not depend on the number of threads.
  explicit ObbTree(const SimplexView& body, unsigned threads = 1);
  /// Builds the tree over the listed simplices, real or pseudo, which take the role of the real ones above.
  ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, unsigned threads = 1);
  /// Restores a stored tree. Throws InputError unless it can be traversed safely and its leaves contain every
  /// real simplex once. Its bounds are assumed to be right; bounds_hold() checks them.
  ObbTree(const SimplexView& body, std::vector<TreeNode> nodes, std::vector<LeafBlock> blocks);
  /// Restores a stored tree over the listed simplices.
  ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, std::vector<TreeNode> nodes,
          std::vector<LeafBlock> blocks);

  /// Returns true if every node's boxes contain everything beneath. The completeness of queries depends on
  /// it.
  bool bounds_hold(const SimplexView& body) const;

  bool empty() const { return nodes_.empty(); }
  const std::vector<TreeNode>& nodes() const { return nodes_; }  ///< the root is node 0
  const std::vector<LeafBlock>& blocks() const { return blocks_; }
  double unit() const { return unit_; }      ///< a power of two; coordinates divided by it are in units
  double extent() const { return extent_; }  ///< largest absolute coordinate of a corner, mesh units
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

// Quality measures of a tree's shape, without running a query.

struct TreeQuality {
  std::uint32_t nodes = 0, leaves = 0, simplices = 0, height = 0;
  /// Sum of the areas of inner nodes / area of the root: expected number of inner nodes that a random line
  /// visits.
  double sah_inner = 0;
  double sah_leaves = 0;  ///< as sah_inner, for leaves
  double child_fill = 0;  ///< children / (inner nodes x 8); best 1
  double leaf_fill = 0;   ///< simplices / (leaves x 8); best 1
  /// Fraction of sibling pairs whose boxes overlap, as stored in the parent, on its axes; best near 0.
  double sibling_overlap = 0;
  double bytes_per_simplex = 0;
};
/// Returns the measures of a tree; all 0 for an empty one. Cost model: Goldsmith and Salmon, "Automatic
/// Creation of Object Hierarchies for Ray Tracing", 1987.
TreeQuality tree_quality(const ObbTree& tree);

}  // namespace lrb
