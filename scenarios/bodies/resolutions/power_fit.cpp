#include "scenarios/bodies/resolutions/power_fit.hpp"

#include <algorithm>
#include <cmath>

namespace lrb::resolutions {

PowerFit fit_power(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x, dy = std::log(y[i]) - mean_y;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  PowerFit fit;
  fit.exponent = xy / xx;
  fit.factor = std::exp(mean_y - fit.exponent * mean_x);
  if (x.size() > 2) fit.error = std::sqrt(std::max(0.0, yy - fit.exponent * xy) / (n - 2) / xx);
  return fit;
}

}  // namespace lrb::resolutions
