#pragma once

#include <cstdint>

namespace lrb {

/// The instruction sets that kernels are compiled for.
enum class InstructionSet : std::uint8_t {
  baseline,  ///< what every processor has
  avx2,
  avx512,  ///< still eight lanes, but truth values in mask registers
};

/// Returns the newest that the processor has and that the environment variable LRB_SIMD ("baseline", "avx2")
/// allows.
InstructionSet best_instruction_set();

}  // namespace lrb
