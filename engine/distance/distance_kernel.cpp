#include "engine/distance/distance_kernel.hpp"

#include "engine/distance/near_kernel.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {

void run_distance_kernel_baseline(DistanceKernel& k);
void run_near_kernel_baseline(TreeKernel& k);
void run_pair_bounds_kernel_baseline(const PairBoundsKernel& k);
#if defined(__x86_64__)
void run_distance_kernel_avx2(DistanceKernel& k);
void run_near_kernel_avx2(TreeKernel& k);
void run_pair_bounds_kernel_avx2(const PairBoundsKernel& k);
void run_distance_kernel_avx512(DistanceKernel& k);
void run_near_kernel_avx512(TreeKernel& k);
void run_pair_bounds_kernel_avx512(const PairBoundsKernel& k);
#endif

namespace {

struct Kernels {
  void (*distance)(DistanceKernel&) = run_distance_kernel_baseline;
  void (*near)(TreeKernel&) = run_near_kernel_baseline;
  void (*bounds)(const PairBoundsKernel&) = run_pair_bounds_kernel_baseline;
};

Kernels best_kernels() {
  switch (best_instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return {run_distance_kernel_avx512, run_near_kernel_avx512, run_pair_bounds_kernel_avx512};
    case InstructionSet::avx2:
      return {run_distance_kernel_avx2, run_near_kernel_avx2, run_pair_bounds_kernel_avx2};
#endif
    default:
      return {};
  }
}

const Kernels& kernels() {
  // Selected at the first call.
  static const Kernels best = best_kernels();
  return best;
}

}  // namespace

void run_distance_kernel(DistanceKernel& k) {
  kernels().distance(k);
}

void run_near_kernel(TreeKernel& k) {
  kernels().near(k);
}

void run_pair_bounds_kernel(const PairBoundsKernel& k) {
  kernels().bounds(k);
}

}  // namespace lrb
