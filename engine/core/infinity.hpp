#pragma once

#include <limits>

namespace lrb {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace lrb
