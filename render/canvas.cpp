#include "render/canvas.hpp"

namespace lrb::render {

double text_width(const std::string& text, double height, bool bold) {
  TextStyle style;
  style.height = 256;  // a line's width is measured in whole pixels: of a large font, these are small
  style.bold = bold;
  return default_font().measure(text, style).width * height / style.height;
}

Canvas::Loop corners(const Eigen::AlignedBox2d& box) {
  return {box.min(), {box.max().x(), box.min().y()}, box.max(), {box.min().x(), box.max().y()}};
}

}  // namespace lrb::render
