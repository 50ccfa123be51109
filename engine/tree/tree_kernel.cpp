#include "engine/tree/tree_kernel.hpp"

#include "engine/tree/instruction_set.hpp"
#include "engine/tree/pair_kernel.hpp"

namespace lrb {

void run_tree_kernel_baseline(TreeKernel& k);
void run_affine_kernel_baseline(TreeKernel& k);
void run_pair_kernel_baseline(const PairKernel& k);
#if defined(__x86_64__)
void run_tree_kernel_avx2(TreeKernel& k);
void run_affine_kernel_avx2(TreeKernel& k);
void run_pair_kernel_avx2(const PairKernel& k);
void run_tree_kernel_avx512(TreeKernel& k);
void run_affine_kernel_avx512(TreeKernel& k);
void run_pair_kernel_avx512(const PairKernel& k);
#endif

namespace {

struct Kernels {
  void (*tree)(TreeKernel&) = run_tree_kernel_baseline;
  void (*affine)(TreeKernel&) = run_affine_kernel_baseline;
  void (*pairs)(const PairKernel&) = run_pair_kernel_baseline;
};

Kernels best_kernels() {
  switch (best_instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return {run_tree_kernel_avx512, run_affine_kernel_avx512, run_pair_kernel_avx512};
    case InstructionSet::avx2:
      return {run_tree_kernel_avx2, run_affine_kernel_avx2, run_pair_kernel_avx2};
#endif
    default:
      return {};
  }
}

const Kernels& kernels() {
  // Chosen once, at the first call. The initialisation of a local static is thread-safe.
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

}  // namespace lrb
