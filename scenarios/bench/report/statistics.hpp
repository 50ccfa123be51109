#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace lrb::bench {

/// Returns the value below which a share of the others lies (nearest rank); 0 if there are none.
inline double quantile(std::vector<double> x, double share) {
  if (x.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(x.size())));
  const std::size_t i = std::min(x.size() - 1, rank == 0 ? 0 : rank - 1);
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(i), x.end());
  return x[i];
}
inline double median(const std::vector<double>& x) {
  return quantile(x, 0.5);
}
/// Returns the geometric mean of positive values; 0 if there are none.
inline double geometric_mean(const std::vector<double>& x) {
  if (x.empty()) return 0;
  double sum = 0;
  for (const double v : x) sum += std::log(v);
  return std::exp(sum / static_cast<double>(x.size()));
}

}  // namespace lrb::bench
