#pragma once
/// The inner loop of the complete query: the dual traversal of two OBB trees, in eight-wide float arithmetic
/// whose every error is bounded, so that it drops a pair of simplices only if they cannot meet.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <cstdint>
#include <functional>

#include <lrbscope/obb_tree.hpp>

namespace lrb {

/// Calls visit(s, t), s < t, for all pairs of a tree's simplices, in the body's own frame, that float
/// arithmetic could not prove disjoint: all that meet, and a few that do not. In an unspecified order.
void for_each_self_pair(const ObbTree& tree, const std::function<void(SimplexId, SimplexId)>& visit);

struct NodePair {
  std::uint32_t a, b;
};

/// How two simplices meet, as far as float arithmetic can be certain of it.
enum class Certainty : std::uint8_t {
  none,
  disjoint,
  cross,
  /// They touch if some corners of one are corners of the other too; else nothing is certain.
  touch_if_shared,
};

/// A pair of real simplices that boxes and planes could not prove apart.
struct Candidate {
  SimplexId a, b;
  Certainty certainty;  ///< none if there is a margin
  // For touch_if_shared:
  Side side;             ///< the body to whose simplex the corners belong
  std::uint8_t corners;  ///< bit k: corner k
};

/// A pair of real simplices that a plane parts.
struct PartedPair {
  SimplexId a, b;
  Side whose;  ///< the simplex whose plane it is; A's if both planes part them
};

/// A node that is this many times as large as the other is descended by itself, because all of the other's
/// boxes would meet the same few of its own.
inline constexpr float kMuchLarger = 3;

/// A linear map: columns for double arithmetic, rows rounded for that in floats.
struct KernelMap {
  alignas(32) double columns[3][4];
  float rows[3][3];
  float size;  ///< >= the Euclidean norm
};

/// The maps of two bodies that are not nearly rotations; kernel_setup.hpp explains them. Each pair of entries
/// is for A and B.
struct AffineTerms {
  struct Axes {
    KernelMap other;               ///< coordinates in the other body -> these axes
    alignas(32) double origin[4];  ///< of the other body, on these axes
    KernelMap own;                 ///< coordinates in this body -> these axes; the identity unless flat
    bool flat;
    float slack;  ///< as TreeKernel::slack, on these axes
  } axes[2];
  KernelMap world[2];             ///< coordinates in a body -> the world's axes
  alignas(32) double between[4];  ///< B's origin seen from A's, on the world's axes
  float world_slack;
  int exponent;   ///< the query's unit is 2^exponent
  float span[2];  ///< about the size in the world, in query units, of a length of 1 in the tree's units
};

/// TreeKernel::most_node_pairs of a kernel that stops only when it is done.
inline constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

/// One traversal. All lengths are in the query's unit: the larger of the two trees' units.
struct TreeKernel {
  const TreeNode* nodes_a;
  const TreeNode* nodes_b;
  const LeafBlock* blocks_a;
  const LeafBlock* blocks_b;
  float ratio_a, ratio_b;      ///< tree's unit / query's unit: powers of two, at most 1
  alignas(32) double m[3][4];  ///< from B's axes to A's, by columns (m[column][row])
  alignas(32) double t[4];     ///< B's origin seen from A's, in A's axes
  float m_rows[3][3];          ///< m rounded, by rows: m_rows[row][column] = m[column][row]
  float slack;  ///< absolute: errors of poses and of the rounding of world coordinates (see kernel_setup.cpp)
  float m_size;  ///< >= 1 and >= the Euclidean norm of m
  /// 0, or else pairs are kept that may meet once the points of B have been displaced by -1 to 1 times (sweep
  /// x + sweep_t) and then by no more than this.
  float margin;
  alignas(32) double sweep[3][4], sweep_t[4];  ///< laid out as m and t
  float sweep_turn;                            ///< >= the Euclidean norm of sweep
  bool nearest_first;   ///< without a margin: descend first where boxes overlap most, at the beginning
  AffineTerms* affine;  ///< null, or these maps take the place of m, t and slack (without a margin)

  /// Pairs of nodes to be visited, for which there must be room: see stack_room(). Where whole nodes are
  /// compared first, pairs that this does not part are moved from `stack` to `tested`.
  NodePair *stack, *tested;
  std::uint32_t stack_size, tested_size;
  std::uint32_t base;  ///< number of pairs on the stack that the search for the nearest boxes left there
  Candidate* out;
  std::uint32_t out_capacity;  ///< at least 64
  std::uint32_t out_size;

  PartedPair*
      parted;  ///< null, or room for 64 pairs: those that planes part; only for one pair of nodes at a time
  std::uint32_t parted_size;

  // For whoever watches one step after another; a step ends with the first pair of nodes that it adds to
  // node_pairs:
  NodePair* parted_nodes;  ///< null, or as much room as in `stack`: those that were parted as wholes
  std::uint32_t parted_nodes_size;
  NodePair opened;          ///< the last pair whose boxes inside were compared
  std::uint32_t opened_at;  ///< stack_size without the pairs that came of it

  std::uint64_t node_pairs, box_tests, prefilter_tests;
  std::uint64_t most_node_pairs;  ///< where to stop, or up to 71 later; may be raised to go on
};

/// Traverses until no pair waits, fewer than 64 places are left in `out`, or most_node_pairs are
/// reached. Uses the newest instruction set that the processor has; the environment variable LRB_SIMD, read
/// at the first call, limits it to AVX2 ("avx2") or to what every processor has ("baseline"). The outcome is
/// the same, counters included (tests/reproducibility/reproducibility.sh).
void run_tree_kernel(TreeKernel& k);

}  // namespace lrb
