#include "render/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lrb::palette {

Rgba viridis(double t) {
  // Every sixteenth of the map that matplotlib published into the public domain (CC0); linear in between,
  // which is nowhere off by more than what an eye can see.
  static constexpr std::array<Rgba, 17> kStops = {{{68, 1, 84},
                                                   {72, 23, 105},
                                                   {71, 44, 122},
                                                   {66, 64, 134},
                                                   {59, 82, 139},
                                                   {51, 99, 141},
                                                   {44, 114, 142},
                                                   {38, 130, 142},
                                                   {33, 145, 140},
                                                   {31, 160, 136},
                                                   {40, 174, 128},
                                                   {63, 188, 115},
                                                   {94, 201, 98},
                                                   {132, 212, 75},
                                                   {173, 220, 48},
                                                   {216, 226, 25},
                                                   {253, 231, 37}}};
  const double at = (t > 0 ? std::min(t, 1.0) : 0.0) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  return mix(kStops[i], kStops[i + 1], at - static_cast<double>(i));
}

Rgba category(std::uint32_t index) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr std::array<double, 3> kLightness = {0.70, 0.80, 0.60};
  constexpr double kChroma = 0.115;
  const double hue = 2 * std::numbers::pi * std::fmod(0.08 + kGolden * index, 1.0);
  const double l = kLightness[index % kLightness.size()];
  const double a = kChroma * std::cos(hue), b = kChroma * std::sin(hue);
  // Oklab to linear RGB (B. Ottosson, "A perceptual color space for image processing", 2020).
  const auto cube = [](double x) { return x * x * x; };
  const double lms_l = cube(l + 0.3963377774 * a + 0.2158037573 * b);
  const double lms_m = cube(l - 0.1055613458 * a - 0.0638541728 * b);
  const double lms_s = cube(l - 0.0894841775 * a - 1.2914855480 * b);
  const auto byte = [](double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(255 * s + 0.5);
  };
  return {byte(4.0767416621 * lms_l - 3.3077115913 * lms_m + 0.2309699292 * lms_s),
          byte(-1.2684380046 * lms_l + 2.6097574011 * lms_m - 0.3413193965 * lms_s),
          byte(-0.0041960863 * lms_l - 0.7034186147 * lms_m + 1.7076147010 * lms_s)};
}

}  // namespace lrb::palette
