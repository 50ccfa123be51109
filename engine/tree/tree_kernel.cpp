#include "engine/tree/tree_kernel.hpp"

#include "engine/tree/build_kernel.hpp"
#include "engine/tree/kernel_choice.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {

void for_each_self_pair(const ObbTree& tree, const std::function<void(SimplexId, SimplexId)>& visit) {
  if (tree.empty()) return;
  // The tree against itself in the same pose. Every pair is found twice, and every simplex with itself.
  TreeKernel k = set_up_kernel(tree, Pose{}, tree, Pose{});
  std::vector<NodePair> pairs;
  std::vector<Candidate> candidates(4096);
  start_at_roots(k, tree, tree, pairs);
  k.out = candidates.data();
  k.out_capacity = static_cast<std::uint32_t>(candidates.size());
  // The kernel stops when the output buffer is nearly full, and resumes there.
  while (!is_done(k)) {
    k.out_size = 0;
    run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.out_size; ++i)
      // Keep one of the two orders; this also removes pairs of equal simplices.
      if (candidates[i].a < candidates[i].b) visit(candidates[i].a, candidates[i].b);
  }
}

LRB_KERNEL_VERSIONS(run_tree_kernel, TreeKernel&)
LRB_KERNEL_VERSIONS(run_affine_kernel, TreeKernel&)
void run_tree_kernel(TreeKernel& k) {
  static const auto rigid = LRB_BEST_KERNEL(run_tree_kernel), affine = LRB_BEST_KERNEL(run_affine_kernel);
  (k.affine != nullptr ? affine : rigid)(k);
}

LRB_KERNEL(run_pair_kernel, const PairKernel&)
LRB_KERNEL(run_split_kernel, SplitKernel&)
LRB_KERNEL(run_divide_kernel, DivideKernel&)
LRB_KERNEL(run_node_kernel, const NodeKernel&)

}  // namespace lrb
