#pragma once
/// Puts panels that are SVG side by side: what montage() does with pixels.

#include <string>
#include <vector>

#include "render/montage.hpp"

namespace lrb::render {

struct SvgMontageOptions {
  std::string title;         ///< for people who cannot see the picture; empty: none
  bool transparent = false;  ///< else with the style's background
  StyleName style = StyleName::screen;
  double units_per_pixel = 1;  ///< units of the view box per pixel of a screen: the size on paper
};

/// Puts pictures that svg() wrote where `layout` has the panels, and its captions as text.
std::string svg_montage(const std::vector<std::string>& panels, const MontageLayout& layout,
                        const SvgMontageOptions& options = {});

}  // namespace lrb::render
