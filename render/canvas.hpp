#pragma once
/// Paper to paint on, whatever file it becomes: SVG (svg_canvas.hpp), PDF or pixels (cairo_canvas.hpp).
/// Whoever paints does not know which. Lengths are in the paper's own units, x to the right, y down.

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "render/image.hpp"
#include "render/text.hpp"

namespace lrb::render {

struct Pen {
  Rgba colour;
  double width = 1;
  double dash = 0;  ///< length of dashes and of the gaps between; 0: solid, with round ends
};

/// One line of text. `at` is its left end, middle or right end, halfway between ascent and descent.
struct PaperText {
  Eigen::Vector2d at{0, 0};
  std::string text;   ///< UTF-8
  double height = 8;  ///< from ascent to descent, as in TextStyle
  bool bold = false;
  Rgba colour = kBlack;
  Align align = Align::left;
  Rgba halo = kTransparent;  ///< an outline that keeps text legible on anything
};

class Canvas {
 public:
  using Loop = std::vector<Eigen::Vector2d>;

  virtual ~Canvas() = default;
  /// Fills the inside of closed loops by the even-odd rule.
  virtual void fill(const std::vector<Loop>& loops, Rgba colour) = 0;
  virtual void stroke(const Loop& points, bool closed, const Pen& pen) = 0;
  virtual void disc(const Eigen::Vector2d& at, double radius, Rgba colour) = 0;
  virtual void text(const PaperText& text) = 0;
  virtual void picture(const Image& image, const Eigen::AlignedBox2d& place) = 0;
  /// Keep what is painted in between inside a box. They do not nest.
  virtual void begin_clip(const Eigen::AlignedBox2d& box) = 0;
  virtual void end_clip() = 0;
};

/// The halo of text on each side, as a share of its height.
inline constexpr double kTextHalo = 0.14;
/// The height of DejaVu Sans from ascent to descent, in font sizes.
inline constexpr double kHeightOfFont = 1.164;
/// The base line of a text below the middle of its height, as a share of the height.
inline constexpr double kBaseline = 0.297;

/// Returns the width of a line of text of a given height.
double text_width(const std::string& text, double height, bool bold = false);

/// Returns the corners of a box, for fill().
Canvas::Loop corners(const Eigen::AlignedBox2d& box);

}  // namespace lrb::render
