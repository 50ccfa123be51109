#include "engine/distance/distance_kernel.hpp"

#include "engine/tree/kernel_setup.hpp"

namespace lrb {

void run_distance_kernel_baseline(DistanceKernel& k);
#if defined(__x86_64__)
void run_distance_kernel_avx2(DistanceKernel& k);
void run_distance_kernel_avx512(DistanceKernel& k);
#endif

namespace {

using Kernel = void (*)(DistanceKernel&);

Kernel best_kernel() {
  switch (best_instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return run_distance_kernel_avx512;
    case InstructionSet::avx2:
      return run_distance_kernel_avx2;
#endif
    default:
      return run_distance_kernel_baseline;
  }
}

}  // namespace

void run_distance_kernel(DistanceKernel& k) {
  // Selected at the first call.
  static const Kernel best = best_kernel();
  best(k);
}

}  // namespace lrb
