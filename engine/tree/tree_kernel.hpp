#pragma once
/// The inner loop of the complete query: the dual traversal of two OBB trees, in eight-wide float arithmetic
/// with bounded errors, so that a pair of simplices is rejected only if it is disjoint.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <cstdint>
#include <functional>

#include <lrbscope/obb_tree.hpp>

namespace lrb {

/// Calls visit(s, t), s < t, for all pairs of a tree's simplices, in the body's frame, that float arithmetic
/// could not prove disjoint: all intersecting pairs, and a few others. In unspecified order.
void for_each_self_pair(const ObbTree& tree, const std::function<void(SimplexId, SimplexId)>& visit);

struct NodePair {
  std::uint32_t a, b;
};

/// The intersection of two simplices as far as float arithmetic decides it.
enum class Certainty : std::uint8_t {
  none,
  disjoint,
  cross,
  /// They touch if the given corners of one are also corners of the other; otherwise undecided.
  touch_if_shared,
};

/// A pair of real simplices that boxes and planes could not prove disjoint.
struct Candidate {
  SimplexId a, b;
  Certainty certainty;  ///< Certainty::none with a margin
  // For touch_if_shared:
  Side side;             ///< the body to whose simplex the corners belong
  std::uint8_t corners;  ///< bit k: corner k
};

/// A pair of real simplices that a plane separates.
struct RejectedPair {
  SimplexId a, b;
  Side whose;  ///< the simplex that spans the plane; A's if both planes separate
};

/// A node that is larger than the other by this factor is descended alone, because all boxes of the other
/// would intersect the same few of its own.
inline constexpr float kMuchLarger = 3;

/// A linear map: columns for double arithmetic, rounded rows for float arithmetic.
struct KernelMap {
  alignas(32) double columns[3][4];
  float rows[3][3];
  float size;  ///< >= the Euclidean norm
};

/// The maps of two bodies that are not nearly rotations, explained in kernel_setup.hpp. Each pair of entries
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
  alignas(32) double between[4];  ///< B's origin relative to A's, on the world's axes
  float world_slack;
  int exponent;   ///< the query's unit is 2^exponent
  float span[2];  ///< approximate size in the world, in query units, of a length of 1 in the tree's units
};

/// TreeKernel::max_node_pairs of a kernel without a limit.
inline constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

/// The state of one traversal. All lengths are in the query's unit: the larger of the two trees' units.
struct TreeKernel {
  const TreeNode* nodes_a;
  const TreeNode* nodes_b;
  const LeafBlock* blocks_a;
  const LeafBlock* blocks_b;
  float ratio_a, ratio_b;      ///< tree's unit / query's unit: powers of two, at most 1
  alignas(32) double m[3][4];  ///< from B's axes to A's, by columns (m[column][row])
  alignas(32) double t[4];     ///< B's origin relative to A's, on A's axes
  float m_rows[3][3];          ///< m rounded, by rows: m_rows[row][column] = m[column][row]
  float slack;   ///< absolute: errors of poses and rounding of world coordinates (see kernel_setup.cpp)
  float m_size;  ///< >= 1 and >= the Euclidean norm of m
  /// 0, or: keep pairs that may intersect after the points of B are displaced by -1 to 1 times (sweep x +
  /// sweep_t) and then by at most this.
  float margin;
  alignas(32) double sweep[3][4], sweep_t[4];  ///< layout as m and t
  float sweep_turn;                            ///< >= the Euclidean norm of sweep
  bool nearest_first;   ///< without a margin: at the beginning, descend first where boxes overlap most
  AffineTerms* affine;  ///< null, or maps that replace m, t and slack (without a margin)

  /// Pairs of nodes to be visited; capacity: see stack_room(). Where node boxes are tested first, pairs that
  /// may intersect are moved from `stack` to `tested`.
  NodePair *stack, *tested;
  std::uint32_t stack_size, tested_size;
  std::uint32_t base;  ///< number of pairs left on the stack by the search for the closest boxes
  Candidate* out;
  std::uint32_t out_capacity;  ///< at least 64
  std::uint32_t out_size;

  /// Null, or space for 64 pairs: those that planes separate; only for one pair of nodes at a time.
  RejectedPair* rejected;
  std::uint32_t rejected_size;

  // For observation step by step; a step ends with the first pair of nodes that it adds to node_pairs:
  NodePair* rejected_nodes;  ///< null, or as much space as `stack`: the pairs rejected by their node boxes
  std::uint32_t rejected_nodes_size;
  NodePair opened;          ///< the last pair that was expanded
  std::uint32_t opened_at;  ///< stack_size before its children were pushed

  std::uint64_t node_pairs, box_tests, prefilter_tests;
  std::uint64_t max_node_pairs;  ///< where to stop, at most 71 pairs late; may be raised to continue
};

/// Traverses until no pair is waiting, fewer than 64 places are left in `out`, or max_node_pairs are
/// reached. Uses the newest instruction set of the processor; the environment variable LRB_SIMD, read at the
/// first call, limits it to AVX2 ("avx2") or to the minimum of the platform ("baseline"). The result is the
/// same, including counters (tests/reproducibility/reproducibility.sh).
void run_tree_kernel(TreeKernel& k);

// The pair kernel: for given pairs of triangles, eight at a time, decides in float arithmetic with bounded
// errors whether they cross or are disjoint, and computes lower bounds of their distance.

/// A simplex in query units: its first corner, in a frame with the axes of its body, and the edges from there
/// to the other corners. For small simplices these differences and their errors are small. A segment repeats
/// its second corner.
struct alignas(16) CachedSimplex {
  float corner[3], edge[2][3];
  float longest;  ///< length of the longest edge, rounded up
  float unused[2];
};

/// A simplex of A and one of B, by their indices in PairKernel::a and b.
struct CachedPair {
  std::uint32_t a, b;
};

/// One bit for each of eight pairs; undecided if neither is set.
struct PairVerdicts {
  std::uint8_t cross, disjoint;
};

struct PairKernel {
  const CachedSimplex *a, *b;
  const CachedPair* pairs;  ///< (8 block_count)
  std::uint32_t block_count;
  float r[3][3], t[3];       ///< A's frame <- B's frame: r x + t
  float radius_a, radius_b;  ///< radii of balls about the frames' origins that contain all first corners
  float slack, m_size;       ///< as in TreeKernel

  PairVerdicts* verdicts;  ///< (block_count), or null if not requested

  /// (8 block_count), or null if not requested. Each pair can intersect only after a motion in [from, to]. If
  /// `is_swept`, the motion displaces the points of B, relative to A's frame, by s times (sweep x + sweep_t),
  /// s in [-1, 1], and then by at most `margin`: the interval is one of s. Otherwise the motion is arbitrary,
  /// and the interval is one of its length, query units.
  float *from, *to;
  bool is_swept;
  float sweep[3][3], sweep_t[3];  ///< rows; on A's axes <- in B's frame
  float sweep_turn, margin;
};

/// Runs the kernel with the instruction set of run_tree_kernel(). The result does not depend on the
/// instruction set.
void run_pair_kernel(const PairKernel& k);

}  // namespace lrb
