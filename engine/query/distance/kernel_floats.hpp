#pragma once

#include <algorithm>

#include "engine/core/tolerances.hpp"

namespace lrb {

/// Returns a number of the kernel's, such as a length in query units, as a float that is not less, or not
/// more and at least 0.
inline float rounded_up(double x) {
  return static_cast<float>(x) * kFloatUp + kKernelTiny;
}
inline float rounded_down(double x) {
  return std::max(0.0F, static_cast<float>(x) * (2 - kFloatUp) - kKernelTiny);
}

}  // namespace lrb
