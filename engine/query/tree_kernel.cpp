#include "engine/query/tree_kernel.hpp"

#include <cstdlib>
#include <string_view>

#include "engine/query/pair_kernel.hpp"

namespace lrb {

void run_tree_kernel_baseline(TreeKernel& k);
void run_pair_kernel_baseline(const PairKernel& k);
#if defined(__x86_64__)
void run_tree_kernel_avx2(TreeKernel& k);
void run_pair_kernel_avx2(const PairKernel& k);
#endif

namespace {

struct Kernels {
  void (*tree)(TreeKernel&) = run_tree_kernel_baseline;
  void (*pairs)(const PairKernel&) = run_pair_kernel_baseline;
};

Kernels best_kernels() {
#if defined(__x86_64__)
  const char* wish = std::getenv("LRB_SIMD");
  if (__builtin_cpu_supports("avx2") && !(wish && std::string_view(wish) == "baseline"))
    return {run_tree_kernel_avx2, run_pair_kernel_avx2};
#endif
  return {};
}

const Kernels& kernels() {
  static const Kernels best = best_kernels();
  return best;
}

}  // namespace

void run_tree_kernel(TreeKernel& k) {
  kernels().tree(k);
}

void run_pair_kernel(const PairKernel& k) {
  kernels().pairs(k);
}

}  // namespace lrb
