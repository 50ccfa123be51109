#pragma once
/// Writes a draw list as a camera sees it as SVG: pictures of 2D scenes for print, sharp at any size, with
/// text that stays text.

#include <optional>
#include <string>

#include "render/camera.hpp"
#include "render/draw_list.hpp"

namespace lrb::render {

struct SvgOptions {
  double width = 1280, height = 720;  ///< of the view box; widths and radii of the list are in its units
  std::optional<Rgba> background = kWhite;  ///< nothing: transparent
  std::string title;                        ///< for people who cannot see the picture; empty: none
  double units_per_pixel = 1;  ///< units of the view box per pixel of a screen (1/96 inch): the size on paper
};

/// Returns the picture that Rasterizer::draw() gives of a scene without depth: fills, then lines and points
/// layer by layer in the order of the list, then labels. Every machine gives the same bytes. Throws
/// InputError if the list has triangles (which hides which is decided pixel by pixel there), and where
/// Projection does.
std::string svg(const DrawList& list, const Camera& camera, const SvgOptions& options = {});

}  // namespace lrb::render
