#pragma once
/// A canvas that becomes SVG, in which text stays text. Gives the same bytes on every machine.

#include <optional>
#include <string>

#include "render/canvas.hpp"

namespace lrb::render {

class SvgCanvas : public Canvas {
 public:
  void fill(const std::vector<Loop>& loops, Rgba colour) override;
  void stroke(const Loop& points, bool closed, const Pen& pen) override;
  void disc(const Eigen::Vector2d& at, double radius, Rgba colour) override;
  void text(const PaperText& text) override;
  void picture(const Image& image, const Eigen::AlignedBox2d& place) override;
  void begin_clip(const Eigen::AlignedBox2d& box) override;
  void end_clip() override;

  /// Returns what has been painted, as elements.
  const std::string& elements() const { return out_; }

 private:
  std::string out_;
  int clips_ = 0;
};

struct SvgPage {
  double width = 0, height = 0;  ///< of the view box
  double units_per_pixel = 1;  ///< units of the view box per pixel of a screen (1/96 inch): the size on paper
  std::string title;           ///< for people who cannot see the picture; empty: none
  std::optional<Rgba> background = kWhite;  ///< nothing: transparent
};

/// Returns a whole file.
std::string svg_file(const SvgCanvas& canvas, const SvgPage& page);

}  // namespace lrb::render
