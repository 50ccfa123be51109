#include "engine/query/tree_kernel.hpp"

namespace lrb {

void run_tree_kernel_baseline(TreeKernel& k);
#if defined(__x86_64__)
void run_tree_kernel_avx2(TreeKernel& k);
#endif

void run_tree_kernel(TreeKernel& k) {
#if defined(__x86_64__)
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  if (has_avx2) return run_tree_kernel_avx2(k);
#endif
  run_tree_kernel_baseline(k);
}

}  // namespace lrb
