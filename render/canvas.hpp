#pragma once
/// An abstract canvas. Implementations write SVG (SvgCanvas), PDF or pixels (CairoCanvas). Lengths are in the
/// canvas's own units, x to the right, y down.

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

/// Returns bytes as base64 text (RFC 4648) with padding, as pictures are embedded in SVG and HTML.
std::string base64(const std::uint8_t* bytes, std::size_t size);

struct Pen {
  Rgba colour;
  double width = 1;
  double dash = 0;  ///< length of dashes and of gaps; 0: solid, with round ends
};

/// One line of text. `at` is its left end, centre or right end, halfway between ascent and descent.
struct PaperText {
  Eigen::Vector2d at{0, 0};
  std::string text;   ///< UTF-8
  double height = 8;  ///< from ascent to descent, as in TextStyle
  bool bold = false;
  Rgba colour = kBlack;
  Align align = Align::left;
  Rgba halo = kTransparent;  ///< an outline that keeps text legible on any background
};

class Canvas {
 public:
  using Loop = std::vector<Eigen::Vector2d>;

  virtual ~Canvas() = default;
  /// Fills the interior of closed loops by the even-odd rule, enlarged by `spread` on each side.
  virtual void fill(const std::vector<Loop>& loops, Rgba colour, double spread = 0) = 0;
  virtual void stroke(const Loop& points, bool closed, const Pen& pen) = 0;
  /// Draws open lines as one shape: translucent lines do not add up where they overlap.
  virtual void strokes(const std::vector<Loop>& lines, const Pen& pen) = 0;
  virtual void disc(const Eigen::Vector2d& at, double radius, Rgba colour) = 0;
  virtual void text(const PaperText& text) = 0;
  virtual void picture(const Image& image, const Eigen::AlignedBox2d& place) = 0;
  /// Clip everything painted in between to a box. Clips do not nest.
  virtual void begin_clip(const Eigen::AlignedBox2d& box) = 0;
  virtual void end_clip() = 0;
};

/// The halo of text on each side, as a share of its height.
inline constexpr double kTextHalo = 0.14;
/// The height of DejaVu Sans from ascent to descent, in font sizes.
inline constexpr double kHeightOfFont = 1.164;
/// Offset of the baseline below the centre of the text's height, as a share of the height.
inline constexpr double kBaseline = 0.297;

/// Returns the width of a line of text of a given height.
double text_width(const std::string& text, double height, bool bold = false);

/// Returns the corners of a box, for fill().
Canvas::Loop corners(const Eigen::AlignedBox2d& box);

// Writes PDF or pixels with cairo. Text uses the fonts of text.hpp, which are embedded in a PDF.

inline constexpr double kPointsPerInch = 72;

struct PaperPage {
  double width = 0, height = 0;             ///< points
  std::optional<Rgba> background = kWhite;  ///< nullopt: transparent
  std::string title;                        ///< in a PDF's properties; empty: none
  std::string creator;                      ///< the program's name in a PDF's properties; empty: none
};

/// Returns the page painted by `paint`, in points, as a PDF. It contains no creation date, so that equal
/// pages give equal bytes. Throws EnvironmentError.
std::string paint_pdf(const PaperPage& page, const std::function<void(Canvas&)>& paint);

/// Returns the page as pixels, `dpi` per inch; sizes are rounded up to whole pixels.
Image paint_pixels(const PaperPage& page, double dpi, const std::function<void(Canvas&)>& paint);

/// Escapes text for SVG and HTML, for elements and for quoted attributes. Bytes that are not UTF-8 become
/// U+FFFD.
std::string escape_markup(std::string_view text);

/// Returns the outlines of a line of text as the data of an SVG path.
std::string text_outlines(const PaperText& text);

// A canvas that writes SVG. Gives the same bytes on every machine.

class SvgCanvas : public Canvas {
 public:
  /// text: names the font, which the machine that shows it may lack. outlines: shapes of the glyphs, labelled
  /// with their text, that look the same everywhere.
  enum class Texts : std::uint8_t { text, outlines };
  explicit SvgCanvas(Texts texts = Texts::text) : texts_(texts) {}

  void fill(const std::vector<Loop>& loops, Rgba colour, double spread = 0) override;
  void stroke(const Loop& points, bool closed, const Pen& pen) override;
  void strokes(const std::vector<Loop>& lines, const Pen& pen) override;
  void disc(const Eigen::Vector2d& at, double radius, Rgba colour) override;
  void text(const PaperText& text) override;
  void picture(const Image& image, const Eigen::AlignedBox2d& place) override;
  void begin_clip(const Eigen::AlignedBox2d& box) override;
  void end_clip() override;

  /// Returns everything painted so far, as SVG elements.
  const std::string& elements() const { return out_; }

 private:
  void stroke_path(const std::string& d, const Pen& pen);

  Texts texts_;
  std::string out_;
  int clips_ = 0;
};

struct SvgPage {
  double width = 0, height = 0;  ///< of the view box
  double units_per_pixel = 1;    ///< units of the view box per screen pixel (1/96 inch): the size on paper
  std::string title;             ///< alternative text for screen readers; empty: none
  std::optional<Rgba> background = kWhite;  ///< nullopt: transparent
  bool millimetres = false;                 ///< gives the size in mm, not in pixels
};

/// Returns a complete file.
std::string svg_file(const SvgCanvas& canvas, const SvgPage& page);

}  // namespace lrb::render
