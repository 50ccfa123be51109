#pragma once

#include <span>

namespace lrb::resolutions {

/// A fit y = factor x^exponent.
struct PowerFit {
  double exponent = 0;
  double error = 0;  ///< standard error of the exponent; 0 for fewer than three points
  double factor = 0;
};

/// Fits a straight line to the logarithms, with the least sum of squares. x and y must be positive and of one
/// length, with at least two different x.
PowerFit fit_power(std::span<const double> x, std::span<const double> y);

}  // namespace lrb::resolutions
