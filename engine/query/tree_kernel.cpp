#include "engine/query/tree_kernel.hpp"

#include <cstdlib>
#include <string_view>

namespace lrb {

void run_tree_kernel_baseline(TreeKernel& k);
#if defined(__x86_64__)
void run_tree_kernel_avx2(TreeKernel& k);
#endif

namespace {

#if defined(__x86_64__)
bool may_use_avx2() {
  const char* wish = std::getenv("LRB_SIMD");
  return __builtin_cpu_supports("avx2") && !(wish && std::string_view(wish) == "baseline");
}
#endif

}  // namespace

void run_tree_kernel(TreeKernel& k) {
#if defined(__x86_64__)
  static const bool avx2 = may_use_avx2();
  if (avx2) return run_tree_kernel_avx2(k);
#endif
  run_tree_kernel_baseline(k);
}

}  // namespace lrb
