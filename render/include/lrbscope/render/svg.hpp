#pragma once
/// Writes a draw list as a camera sees it as SVG: pictures of 2D scenes for print, sharp at any size, with
/// text that stays text.

#include <optional>
#include <string>
#include <vector>

#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>

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

// Puts panels that are SVG side by side: what montage() does with pixels.

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

namespace lrb::render::svg_text {

// What writers of SVG share: numbers, attributes, colours, fonts. Gives the same bytes in any locale.

/// Returns a number with two decimals at most.
std::string number(double x);
/// Returns ` name="value"`; the value must need no escaping.
std::string attribute(const std::string& name, const std::string& value);
/// Returns a colour as fill or stroke (`what`), with its opacity if it has one.
std::string paint(const std::string& what, Rgba c);
/// Returns font and size of text that is `height` high from ascent to descent, as in TextStyle.
std::string font(double height);
/// Returns the root element's start tag. `units_per_pixel`: units of the view box per pixel of a screen.
std::string svg_open(double width, double height, double units_per_pixel = 1);

}  // namespace lrb::render::svg_text
