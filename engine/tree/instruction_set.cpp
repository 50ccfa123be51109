#include "engine/tree/instruction_set.hpp"

#include <cstdlib>
#include <string_view>

namespace lrb {

InstructionSet best_instruction_set() {
#if defined(__x86_64__)
  const char* const wish = std::getenv("LRB_SIMD");
  const std::string_view most = wish != nullptr ? wish : "";
  // All features that the AVX-512 kernels are compiled with must be present.
  const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                          __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                          __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                          __builtin_cpu_supports("popcnt");
  if (most != "baseline" && most != "avx2" && has_avx512) return InstructionSet::avx512;
  if (most != "baseline" && __builtin_cpu_supports("avx2")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

}  // namespace lrb
