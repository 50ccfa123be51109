#pragma once
/// Selects the version of a kernel that was compiled for the newest instruction set of the processor.

#include <cstdint>

namespace lrb {

/// The instruction sets for which kernels are compiled.
enum class InstructionSet : std::uint8_t {
  baseline,  ///< the minimum of the platform
  avx2,
  avx512,  ///< still eight lanes, but with mask registers
};

/// Returns the newest instruction set of the processor that the environment variable LRB_SIMD ("baseline",
/// "avx2") permits.
InstructionSet best_instruction_set();

/// Returns one of the versions, in the order of InstructionSet.
template <class Kernel, class... Newer>
Kernel* best_kernel(Kernel* baseline, Newer*... newer) {
  Kernel* const versions[] = {baseline, newer...};
  return versions[static_cast<int>(best_instruction_set())];
}

}  // namespace lrb

#if defined(__x86_64__)
#define LRB_KERNEL_VERSIONS(name, Argument) \
  void name##_baseline(Argument);           \
  void name##_avx2(Argument);               \
  void name##_avx512(Argument);
#define LRB_BEST_KERNEL(name) best_kernel(name##_baseline, name##_avx2, name##_avx512)
#else
#define LRB_KERNEL_VERSIONS(name, Argument) void name##_baseline(Argument);
#define LRB_BEST_KERNEL(name) best_kernel(name##_baseline)
#endif

/// Defines name(k). The version is selected at the first call; the initialisation of a local static is
/// thread-safe.
#define LRB_KERNEL(name, Argument)                  \
  LRB_KERNEL_VERSIONS(name, Argument)               \
  void name(Argument k) {                           \
    static const auto best = LRB_BEST_KERNEL(name); \
    best(k);                                        \
  }
