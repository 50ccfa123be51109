#pragma once
/// Writes numbers as the reports show them.

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "render/overlay.hpp"

namespace lrb::paper {

inline std::string whole(double x) {
  return (x < 0 ? "-" : "") + render::group_digits(static_cast<std::uint64_t>(std::llround(std::abs(x))));
}

/// Writes so many digits after the point; those before it in groups of three.
inline std::string fixed(double x, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << std::abs(x);
  const std::string text = out.str();
  const std::size_t point = std::min(text.find('.'), text.size());
  return (x < 0 ? "-" : "") + render::group_digits(std::stoull(text.substr(0, point))) + text.substr(point);
}

}  // namespace lrb::paper
