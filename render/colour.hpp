#pragma once

#include <cstdint>

namespace lrb::render {

/// A colour in 8-bit sRGB with straight (not premultiplied) alpha.
struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  friend bool operator==(const Rgba&, const Rgba&) = default;
};

constexpr Rgba with_alpha(Rgba c, std::uint8_t a) {
  return {c.r, c.g, c.b, a};
}

/// Moves `c` towards `to` by t in [0, 1], channel by channel, alpha included.
constexpr Rgba mix(Rgba c, Rgba to, double t) {
  const auto channel = [t](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(x + (static_cast<double>(y) - x) * t + 0.5);
  };
  return {channel(c.r, to.r), channel(c.g, to.g), channel(c.b, to.b), channel(c.a, to.a)};
}

/// Returns x / 255 rounded to nearest, for a product x of two bytes.
constexpr int div255(int x) {
  return (x + 127) / 255;
}

/// Paints `top` over `below`, with `coverage` (0..255) as a further factor of its alpha. Computes in integers
/// only, so that every machine gives the same bytes.
constexpr Rgba over(Rgba top, Rgba below, int coverage = 255) {
  const int at = div255(top.a * coverage);
  if (at == 255) return top;
  if (at == 0) return below;
  const int ab = div255(below.a * (255 - at));
  const int a = at + ab;
  const auto channel = [&](int t, int b) { return static_cast<std::uint8_t>((t * at + b * ab + a / 2) / a); };
  return {channel(top.r, below.r), channel(top.g, below.g), channel(top.b, below.b),
          static_cast<std::uint8_t>(a)};
}

/// Returns the luma of Rec. 601, 0..255: how bright the colour is in a greyscale print.
constexpr double luma(Rgba c) {
  return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
}

inline constexpr Rgba kWhite{255, 255, 255};
inline constexpr Rgba kBlack{0, 0, 0};
inline constexpr Rgba kTransparent{0, 0, 0, 0};

}  // namespace lrb::render
