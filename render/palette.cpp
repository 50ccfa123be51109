#include "render/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace lrb::render::palette {

Rgba viridis(double t) {
  // Every sixteenth entry of the map that matplotlib published into the public domain (CC0), linear in
  // between: no eye can see the difference.
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
  const glm::dvec3 lab(l, kChroma * std::cos(hue), kChroma * std::sin(hue));
  // Oklab to linear RGB (B. Ottosson, "A perceptual color space for image processing", 2020). Matrices by
  // columns.
  constexpr glm::dmat3 kLabToRoots(1, 1, 1, 0.3963377774, -0.1055613458, -0.0894841775, 0.2158037573,
                                   -0.0638541728, -1.2914855480);
  constexpr glm::dmat3 kLmsToRgb(4.0767416621, -1.2684380046, -0.0041960863, -3.3077115913, 2.6097574011,
                                 -0.7034186147, 0.2309699292, -0.3413193965, 1.7076147010);
  const glm::dvec3 roots = kLabToRoots * lab;
  const glm::dvec3 rgb = kLmsToRgb * (roots * roots * roots);
  const auto byte = [](double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(255 * s + 0.5);
  };
  return {byte(rgb.r), byte(rgb.g), byte(rgb.b)};
}

}  // namespace lrb::render::palette
