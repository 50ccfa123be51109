#include "scenarios/figure/length.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "engine/core/error.hpp"

namespace lrb::figure {

double parse_length(const std::string& text, const std::string& option, double least, double most) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [unit_at, error] = std::from_chars(text.data(), end, value);
  const std::string_view unit(unit_at, static_cast<std::size_t>(end - unit_at));
  const double points = unit == "mm"   ? kPointsPerMm
                        : unit == "cm" ? 10 * kPointsPerMm
                        : unit == "in" ? 72
                        : unit == "pt" ? 1
                                       : 0;
  if (error != std::errc() || points == 0)
    throw InputError(option + ": expected a length such as 85mm, 8.5cm, 3.3in or 240pt, found \"" + text +
                     "\"");
  const double length = value * points;
  if (!(length >= least && length <= most))
    throw InputError(option + ": expected a length from " + length_words(least) + " to " +
                     length_words(most) + ", found \"" + text + "\"");
  return length;
}

std::string length_words(double points) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g mm", points / kPointsPerMm);
  return text;
}

}  // namespace lrb::figure
