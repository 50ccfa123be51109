#pragma once
/// What writers of SVG share: numbers, attributes, colours, fonts. Gives the same bytes in any locale.

#include <string>

#include "render/colour.hpp"

namespace lrb::render::svg_text {

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
