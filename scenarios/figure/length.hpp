#pragma once

#include <string>

namespace lrb::figure {

inline constexpr double kPointsPerMm = 72 / 25.4;

/// Reads a length on paper, such as "85mm", "17.4cm", "3.3in" or "240pt", and returns it in points (1/72
/// inch). Throws InputError that names `option`, also for what is shorter than `least` or longer than `most`
/// points.
double parse_length(const std::string& text, const std::string& option, double least, double most);

/// Returns points in words: "85 mm".
std::string length_words(double points);

}  // namespace lrb::figure
