#pragma once
/// Panels that are SVG, side by side: what montage() is for pixels.

#include <string>
#include <vector>

#include "render/montage.hpp"

namespace lrb::render {

struct SvgMontageOptions {
  std::string title;           ///< for readers that cannot see it; empty: none
  bool transparent = false;    ///< else white
  double units_per_pixel = 1;  ///< of the view box, per pixel of a screen: the size on paper
};

/// Pictures as svg() wrote them, where `layout` puts panels of their sizes, and its captions as text.
std::string svg_montage(const std::vector<std::string>& panels, const MontageLayout& layout,
                        const SvgMontageOptions& options = {});

}  // namespace lrb::render
