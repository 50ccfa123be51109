#pragma once
/// Texts of a figure that a TeX document typesets over its PDF.

#include <string>
#include <vector>

#include "render/canvas.hpp"

namespace lrb::figure {

/// Passes everything but texts on to another canvas, and keeps the texts.
class TextOverlay : public render::Canvas {
 public:
  explicit TextOverlay(render::Canvas& under) : under_(under) {}

  void fill(const std::vector<Loop>& loops, render::Rgba colour, double spread) override {
    under_.fill(loops, colour, spread);
  }
  void stroke(const Loop& points, bool closed, const render::Pen& pen) override {
    under_.stroke(points, closed, pen);
  }
  void strokes(const std::vector<Loop>& lines, const render::Pen& pen) override {
    under_.strokes(lines, pen);
  }
  void disc(const Eigen::Vector2d& at, double radius, render::Rgba colour) override {
    under_.disc(at, radius, colour);
  }
  void text(const render::PaperText& text) override { texts_.push_back(text); }
  void picture(const render::Image& image, const Eigen::AlignedBox2d& place) override {
    under_.picture(image, place);
  }
  void begin_clip(const Eigen::AlignedBox2d& box) override { under_.begin_clip(box); }
  void end_clip() override { under_.end_clip(); }

  /// Returns a TeX file, to be read with \\input, that includes `pdf` and sets the texts over it. Lengths are
  /// in points (1/72 inch).
  std::string tex(const std::string& pdf, double width, double height, double font_size) const;

 private:
  render::Canvas& under_;
  std::vector<render::PaperText> texts_;
};

/// Returns text with the characters that TeX reserves, and those that its fonts lack, as commands.
std::string escape_tex(const std::string& text);

}  // namespace lrb::figure
