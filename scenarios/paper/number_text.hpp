#pragma once
/// Writes numbers as the reports show them.

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

namespace lrb::paper {

inline std::string whole(double x) {
  return std::to_string(std::llround(x));
}

inline std::string fixed(double x, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << x;
  return out.str();
}

}  // namespace lrb::paper
