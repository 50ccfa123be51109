// Compiled once per instruction set by affine_kernel_*.cpp, which define LRB_AFFINE_KERNEL_NAME. Separate
// from the tree kernel, because that one's speed depends on what the compiler inlines into its one loop. See
// tree_kernel.inl.

#include "engine/tree/affine_boxes.inl"
#include "engine/tree/kernel_walk.inl"

namespace lrb {
namespace {

/// Walks the trees of bodies under any affine maps.
struct AffineWalk {
  static constexpr bool kMargin = false;
  static Skewed between(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
    return between_skewed(k, a, b);
  }
  static float size(const TreeKernel& k, const TreeNode& n, Side side) {
    return n.radius * k.affine->span[static_cast<int>(side)];
  }
};

}  // namespace

void LRB_AFFINE_KERNEL_NAME(TreeKernel& k) {
  // No batched test of node boxes here: it assumes that the relative map is a rotation.
  if (k.nearest_first) run_nearest<AffineWalk>(k);
  run<AffineWalk, false>(k, k.most_node_pairs);
}

}  // namespace lrb
