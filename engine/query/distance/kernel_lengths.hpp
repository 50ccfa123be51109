#pragma once

#include <algorithm>

#include "engine/core/tolerances.hpp"

namespace lrb {

/// Returns a length in query units as a float that is not less, or not more.
inline float length_up(double x) {
  return static_cast<float>(x) * kFloatUp + kKernelTiny;
}
inline float length_down(double x) {
  return std::max(0.0F, static_cast<float>(x) * (2 - kFloatUp) - kKernelTiny);
}

}  // namespace lrb
