#pragma once
/// What writers of SVG share: numbers, attributes, colours, fonts. The same bytes whatever the locale.

#include <string>

#include "render/colour.hpp"

namespace lrb::render::svg_text {

/// With two decimals at most.
std::string number(double x);
/// ` name="value"`; the value has to be safe for markup.
std::string attribute(const std::string& name, const std::string& value);
/// A colour as fill or stroke, with its opacity if it has one.
std::string paint(const std::string& what, Rgba c);
/// Font and size of text that is `height` high from ascent to descent, as in TextStyle.
std::string font(double height);
/// The root element's start tag. `units_per_pixel`: of the view box, per pixel of a screen.
std::string svg_open(double width, double height, double units_per_pixel = 1);

}  // namespace lrb::render::svg_text
