#pragma once
/// Paper to paint on, whatever file it becomes: SVG (SvgCanvas), PDF or pixels (CairoCanvas).
/// Whoever paints does not know which. Lengths are in the paper's own units, x to the right, y down.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::render {

/// Returns bytes as text of RFC 4648, with padding: how pictures stand inside SVG and HTML.
std::string base64(const std::uint8_t* bytes, std::size_t size);

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

// Canvases that become PDF or pixels, by cairo. Text is written with the fonts of text.hpp, which a PDF
// holds.

inline constexpr double kPointsPerInch = 72;

struct PaperPage {
  double width = 0, height = 0;             ///< points
  std::optional<Rgba> background = kWhite;  ///< nothing: transparent
  std::string title;                        ///< in a PDF's properties; empty: none
  std::string creator;                      ///< the same: the program
};

/// Returns what `paint` paints, in points, as the bytes of a PDF. They do not tell when they were made, so
/// that they are the same each time. Throws EnvironmentError.
std::string paint_pdf(const PaperPage& page, const std::function<void(Canvas&)>& paint);

/// Returns the same in pixels, `dpi` of them to an inch; sizes are rounded up to whole ones.
Image paint_pixels(const PaperPage& page, double dpi, const std::function<void(Canvas&)>& paint);

/// Escapes text for SVG and HTML, for elements and for quoted attributes.
std::string escape_markup(std::string_view text);

// A canvas that becomes SVG, in which text stays text. Gives the same bytes on every machine.

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
