#include "render/svg_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "render/canvas.hpp"

namespace lrb::render::svg_text {

std::string number(double x) {
  std::array<char, 64> text{};
  const double hundredths = std::round(x * 100);
  const auto end = std::to_chars(text.data(), text.data() + text.size(), hundredths / 100 + 0.0,
                                 std::chars_format::fixed, 2);
  std::string out(text.data(), end.ptr);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

std::string attribute(const std::string& name, const std::string& value) {
  return " " + name + "=\"" + value + "\"";
}

std::string paint(const std::string& what, Rgba c) {
  std::array<char, 8> hex{};
  std::snprintf(hex.data(), hex.size(), "#%02x%02x%02x", c.r, c.g, c.b);
  std::string out = attribute(what, hex.data());
  if (c.a < 255) out += attribute(what + "-opacity", number(c.a / 255.0));
  return out;
}

std::string font(double height) {
  return attribute("font-family", "DejaVu Sans, sans-serif") +
         attribute("font-size", number(height / kHeightOfFont));
}

std::string svg_open(double width, double height, double units_per_pixel) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", number(width / units_per_pixel)) +
         attribute("height", number(height / units_per_pixel)) +
         attribute("viewBox", "0 0 " + number(width) + " " + number(height)) + ">\n";
}

}  // namespace lrb::render::svg_text
