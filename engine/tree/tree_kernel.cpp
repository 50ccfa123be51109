#include "engine/tree/tree_kernel.hpp"

#include "engine/tree/build_kernel.hpp"
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

void run_tree_kernel_baseline(TreeKernel& k);
void run_affine_kernel_baseline(TreeKernel& k);
void run_pair_kernel_baseline(const PairKernel& k);
void run_split_kernel_baseline(SplitKernel& k);
void run_divide_kernel_baseline(DivideKernel& k);
void run_node_kernel_baseline(const NodeKernel& k);
#if defined(__x86_64__)
void run_tree_kernel_avx2(TreeKernel& k);
void run_affine_kernel_avx2(TreeKernel& k);
void run_pair_kernel_avx2(const PairKernel& k);
void run_split_kernel_avx2(SplitKernel& k);
void run_divide_kernel_avx2(DivideKernel& k);
void run_node_kernel_avx2(const NodeKernel& k);
void run_tree_kernel_avx512(TreeKernel& k);
void run_affine_kernel_avx512(TreeKernel& k);
void run_pair_kernel_avx512(const PairKernel& k);
void run_split_kernel_avx512(SplitKernel& k);
void run_divide_kernel_avx512(DivideKernel& k);
void run_node_kernel_avx512(const NodeKernel& k);
#endif

namespace {

struct Kernels {
  void (*tree)(TreeKernel&) = run_tree_kernel_baseline;
  void (*affine)(TreeKernel&) = run_affine_kernel_baseline;
  void (*pairs)(const PairKernel&) = run_pair_kernel_baseline;
  void (*split)(SplitKernel&) = run_split_kernel_baseline;
  void (*divide)(DivideKernel&) = run_divide_kernel_baseline;
  void (*node)(const NodeKernel&) = run_node_kernel_baseline;
};

Kernels best_kernels() {
  switch (best_instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return {run_tree_kernel_avx512,  run_affine_kernel_avx512, run_pair_kernel_avx512,
              run_split_kernel_avx512, run_divide_kernel_avx512, run_node_kernel_avx512};
    case InstructionSet::avx2:
      return {run_tree_kernel_avx2,  run_affine_kernel_avx2, run_pair_kernel_avx2,
              run_split_kernel_avx2, run_divide_kernel_avx2, run_node_kernel_avx2};
#endif
    default:
      return {};
  }
}

const Kernels& kernels() {
  // Selected once, at the first call. The initialisation of a local static is thread-safe.
  static const Kernels best = best_kernels();
  return best;
}

}  // namespace

void run_tree_kernel(TreeKernel& k) {
  (k.affine != nullptr ? kernels().affine : kernels().tree)(k);
}

void run_pair_kernel(const PairKernel& k) {
  kernels().pairs(k);
}

void run_split_kernel(SplitKernel& k) {
  kernels().split(k);
}

void run_divide_kernel(DivideKernel& k) {
  kernels().divide(k);
}

void run_node_kernel(const NodeKernel& k) {
  kernels().node(k);
}

}  // namespace lrb
