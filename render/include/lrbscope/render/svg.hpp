#pragma once
/// Writes a draw list as SVG through a camera: resolution-independent pictures of 2D scenes for print, with
/// real text.

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
  std::optional<Rgba> background = kWhite;  ///< nullopt: transparent
  std::string title;                        ///< alternative text for screen readers; empty: none
  double units_per_pixel = 1;  ///< units of the view box per screen pixel (1/96 inch): the size on paper
};

/// Returns the picture that Rasterizer::draw() gives of a scene without depth: fills, then lines and points
/// layer by layer in list order, then labels. Every machine gives the same bytes. Throws InputError if the
/// list has triangles (their occlusion is resolved per pixel), or if Projection throws it.
std::string svg(const DrawList& list, const Camera& camera, const SvgOptions& options = {});

// Puts SVG panels side by side, as montage() does with pixels.

struct SvgMontageOptions {
  std::string title;         ///< alternative text for screen readers; empty: none
  bool transparent = false;  ///< false: the style's background
  StyleName style = StyleName::screen;
  double units_per_pixel = 1;  ///< units of the view box per screen pixel: the size on paper
};

/// Puts the results of svg() at the panels of `layout`, and its captions as text.
std::string svg_montage(const std::vector<std::string>& panels, const MontageLayout& layout,
                        const SvgMontageOptions& options = {});

}  // namespace lrb::render

namespace lrb::render::svg_text {

// Helpers shared by SVG writers: numbers, attributes, colours, fonts. Output does not depend on the locale.

/// Returns a number with at most two decimals.
std::string number(double x);
/// Returns ` name="value"`. The value must need no escaping.
std::string attribute(const std::string& name, const std::string& value);
/// Returns a colour as fill or stroke (`what`), with its opacity unless it is opaque.
std::string paint(const std::string& what, Rgba c);
/// Returns font and size of text with height `height` from ascent to descent, as in TextStyle.
std::string font(double height);
/// Returns the root element's start tag. `units_per_pixel`: units of the view box per screen pixel.
/// `millimetres`: the size is in mm, not in pixels.
std::string svg_open(double width, double height, double units_per_pixel = 1, bool millimetres = false);

}  // namespace lrb::render::svg_text
