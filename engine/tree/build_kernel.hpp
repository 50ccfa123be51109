#pragma once
/// The kernels that build trees: splits of large ranges of simplices, splits of small ranges down to leaves,
/// and the nodes.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <cstdint>

#include <lrbscope/obb_tree.hpp>

namespace lrb {

/// Number of simplices up to which a range is divided by DivideKernel. Larger: the boxes of the halves are
/// better estimated by boxes on the coordinate axes than by moments. At most 256: indices are bytes there.
inline constexpr std::uint32_t kSmallRange = 256;

/// A range of simplices is measured again, relative to a closer origin, if its variance is below this
/// fraction of the squared size of the range for which it was measured, or its side below kSmallSide of that
/// one's. Smaller: rounding to float hides the distribution of the simplices of small parts.
inline constexpr float kSmallVariance = 0x1p-10f;
inline constexpr double kSmallSide = 0x1p-10;

/// A node of the binary tree over simplices that is collapsed to the 8-wide tree.
struct BinaryNode {
  std::uint32_t begin, end;  ///< range in the order of the simplices
  std::uint32_t left = kNull, right = kNull;
  /// Of a box that contains the simplices: half its surface area, plus a small term for its length.
  double cost = 0;
  bool is_leaf() const { return left == kNull; }
};

/// The simplices of a tree: three corners each. Coordinates times `scale` are in the tree's units.
struct BuildInput {
  const double* vertices;
  const VertexId* corners;
  const SimplexId* simplices;
  double scale;
};

// Large ranges.

/// The box of a simplex in float. The upper end is negated, so that a union takes one minimum of a vector.
struct alignas(32) FloatBox {
  float low[3];
  std::uint32_t simplex;  ///< index in BuildInput
  float negative_high[3];
  std::uint32_t unused;
};

/// Splits a range at the best boundary between two bins of a coordinate axis (Wald 2007).
struct SplitKernel {
  FloatBox* boxes;   ///< (count) the range
  FloatBox* buffer;  ///< (count)
  std::uint32_t count;
  float bounds[8];  ///< FloatBox of the range or of more; the bins divide it

  int axis;
  std::uint32_t left;  ///< number of simplices on the left: a multiple of kTreeWidth
  double cost;         ///< BinaryNode::cost of the range
  float halves[2][8];  ///< `bounds` of the halves
  /// Boxes to the left of the bin with the boundary are moved to the beginning of `boxes`, those to its right
  /// to the beginning of `buffer`, and those in it to the end of `buffer`, in reverse order.
  std::uint32_t before, after;
};

/// Runs the kernel. The result does not depend on the instruction set.
void run_split_kernel(SplitKernel& k);

// Small ranges, and leaves.

/// Four vertices of a leaf, units; some may be repeated.
struct alignas(32) VertexPacket {
  double x[3][4];
};

/// Measures of everything beneath a node, units: weight, mean and central second moments times weight (xx,
/// yy, zz, yz, zx, xy) of its surface, and its box on the body's axes.
struct NodeSum {
  double weight, mean[3], second[6];
  double low[3], high[3];
};

struct LeafSum {
  NodeSum sum;
  const VertexPacket* packets;
  std::uint32_t packet_count;
};

/// Memory of one thread, so that the kernel has no large arrays on its stack.
struct DivideMemory {
  static constexpr std::uint32_t kVertices = 3 * kSmallRange, kSlots = 2048;
  /// Of a simplex: the weight and its products with the point and the squares, relative to the centre of the
  /// range: w x, w y, w z, w; w xx, w yy, w zz, 0; w yz, w zx, w xy, 0; and twice the centre of its box.
  alignas(32) float moments[kSmallRange][16];
  alignas(32) float point[kVertices][4];      ///< relative to the centre of the range, in its diagonal
  alignas(32) double position[kVertices][4];  ///< the same vertex, units
  std::uint32_t slot_vertex[kSlots];          ///< hash table
  std::uint16_t slot_number[kSlots];
  std::uint16_t corner[kSmallRange][3];  ///< numbers of vertices
  std::uint32_t simplex[kSmallRange];
  std::uint8_t order[3][kSmallRange], right[kSmallRange], side[kSmallRange], seen[kVertices],
      place[kVertices];
  /// Cuts of a range: moments of the left half as above, number of leaves in it, estimated cost.
  alignas(32) float cut_moments[3 * kSmallRange / kTreeWidth + 8][12];
  alignas(32) float cut_leaves[3 * kSmallRange / kTreeWidth + 8], cut_cost[3 * kSmallRange / kTreeWidth + 8];
  VertexPacket packets[kSmallRange / kTreeWidth * 6];
};

/// Divides a range of at most kSmallRange simplices into leaves, and fills them.
struct DivideKernel {
  BuildInput in;
  std::uint32_t* order;  ///< indices in `in`, range by range
  BinaryNode* nodes;     ///< in preorder
  std::uint32_t self;    ///< the node of the range
  // For each leaf of the tree:
  TreeNode* leaves;
  LeafBlock* blocks;
  LeafSum* sums;  ///< `packets` point to the memory
  DivideMemory* memory;
  std::uint32_t packet_count;  ///< used in memory->packets
};

/// Runs the kernel. The result does not depend on the instruction set.
void run_divide_kernel(DivideKernel& k);

// Inner nodes.

struct ChildOfNode {
  const NodeSum* sum;
  const LeafSum *begin, *end;  ///< its leaves
};

/// Fills an inner node except for `first`.
struct NodeKernel {
  const NodeSum* sum;
  ChildOfNode children[kTreeWidth];
  std::uint32_t count;
  TreeNode* node;
};

/// Runs the kernel. The result does not depend on the instruction set.
void run_node_kernel(const NodeKernel& k);

}  // namespace lrb
