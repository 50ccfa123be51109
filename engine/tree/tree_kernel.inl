// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_TREE_KERNEL_NAME. Contains only
// plain loops over plain arrays: if a library's inline function were compiled here for a newer processor, the
// linker could select that copy for the entire program.
//
// All instruction sets perform the same floating-point operations, which are not contracted, so that counters
// and traces do not depend on the processor.

#include "engine/tree/kernel_walk.inl"

namespace lrb {
namespace {

/// Traversal for bodies under rotations, or near-rotations.
template <bool kMargin_>
struct RigidWalk {
  static constexpr bool kMargin = kMargin_;
  static Between between(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
    return lrb::between<kMargin>(k, a, b);
  }
  static float size(const TreeKernel& k, const TreeNode& n, Side side) {
    return n.radius * (side == Side::a ? k.ratio_a : k.ratio_b);
  }
  static Lanes apart(const Float8* centre, const Float8* half, const float* other_centre,
                     const float* other_half, const Between&) {
    return lrb::apart(centre, half, other_centre, other_half);
  }
  static void leaves(TreeKernel& k, const TreeNode& a, const TreeNode& b) { leaf_pair<RigidWalk>(k, a, b); }
};

}  // namespace

void LRB_TREE_KERNEL_NAME(TreeKernel& k) {
  // The batched test of node boxes does not support a margin: traverse without it.
  if (k.margin > 0) return run<RigidWalk<true>, false>(k, k.max_node_pairs);
  // The first few pairs of nodes in order of distance, the rest in batches of eight.
  if (k.nearest_first) run_nearest<RigidWalk<false>>(k);
  run_tested<RigidWalk<false>>(k, k.max_node_pairs);
}

}  // namespace lrb
