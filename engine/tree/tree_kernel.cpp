#include "engine/tree/tree_kernel.hpp"

#include <cstdlib>
#include <string_view>

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

#if defined(__x86_64__)
/// Returns true if the processor has what the AVX-512 kernels are compiled for: still eight lanes, but truth
/// values in mask registers.
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
}
#endif

Kernels best_kernels() {
#if defined(__x86_64__)
  const char* const wish = std::getenv("LRB_SIMD");
  const std::string_view most = wish != nullptr ? wish : "";
  if (most != "baseline" && most != "avx2" && has_avx512())
    return {run_tree_kernel_avx512, run_affine_kernel_avx512, run_pair_kernel_avx512};
  if (most != "baseline" && __builtin_cpu_supports("avx2"))
    return {run_tree_kernel_avx2, run_affine_kernel_avx2, run_pair_kernel_avx2};
#endif
  return {};
}

const Kernels& kernels() {
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
