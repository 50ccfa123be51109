#pragma once
/// Draws the annotations of a frame: title, event, counters, colour key, scale. They get separate strips
/// above and below the picture, so that nothing overlaps; text is wrapped, not cut off.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::render {

// Puts pictures side by side in one image: figures with (a), (b), (c), or an overview beside a close-up.

struct Panel {
  Image image;
  std::string caption;  ///< below the panel, after its letter; may be empty
};

struct MontageOptions {
  int columns = 0;        ///< 0: the number that makes the montage closest to 4:3
  int gutter = -1;        ///< between and around panels, pixels; -1: 1/24 of a panel's smaller side
  bool letters = true;    ///< (a), (b), ... below each panel
  bool frame = false;     ///< a thin line around each panel
  float text_height = 0;  ///< pixels; 0: 1/20 of the panels' height, at least 12
  Rgba background = kWhite;
  StyleName style = StyleName::screen;  ///< of captions and frames
};

struct MontageLayout {
  int width = 0, height = 0;
  std::vector<PixelRect> panels;                ///< rectangles of the images
  std::vector<PixelRect> captions;              ///< space for the caption below each
  std::vector<std::vector<std::string>> lines;  ///< caption text, wrapped
  float text_height = 0;
};

/// Lays panels out row by row. Images of different sizes are centred in cells; each column has one width,
/// each row one height. Throws InputError without panels.
MontageLayout lay_out(const std::vector<Panel>& panels, const MontageOptions& options = {});
Image montage(const std::vector<Panel>& panels, const MontageOptions& options = {});

/// Returns "(a)" .. "(z)", "(aa)" ...
std::string panel_letter(std::size_t index);

struct LegendItem {
  enum class Mark : std::uint8_t {
    solid,
    translucent,
    line,
    thin,  ///< a thin line
    dashed,
    ends,  ///< a line between two points
    arrow,
    thin_arrow,
    point
  } mark = Mark::solid;
  Rgba colour;
  std::string text;
  /// The colours that translucent faces are drawn in: of the face, of its edges, and of the surface under it.
  /// nullopt: derived from `colour`.
  struct Swatch {
    Rgba face, edge, under;
  };
  std::optional<Swatch> swatch = {};

  bool is_line() const { return mark != Mark::solid && mark != Mark::translucent && mark != Mark::point; }
};

/// Meaning of the colours of values in this picture.
struct ScaleBar {
  std::string text;          ///< quantity and unit
  double low = 0, high = 1;  ///< values at the two ends
  bool log = false;          ///< logarithmic, with ticks at 1, 2 and 5 times powers of ten; low > 0
};

/// Returns the position of a value on a scale, from 0 at the low end to 1 at the high end; clamped.
double place_on(const ScaleBar& scale, double value);

struct OverlayCounter {
  std::string name, value;
};

struct Overlay {
  std::string title;  ///< bold, first line
  std::string event;  ///< second line, with a marker in event_colour
  Rgba event_colour = kTransparent;
  std::vector<OverlayCounter> counters;
  std::vector<LegendItem> key;
  std::optional<ScaleBar> scale;
  StyleName style = StyleName::screen;
  bool empty() const { return title.empty() && event.empty() && counters.empty() && key.empty() && !scale; }
};

/// The rectangle of each part.
struct OverlayLayout {
  struct Text {
    PixelRect box;
    std::string text;
    bool bold = false, faint = false;
  };
  PixelRect picture;      ///< remaining space for the picture
  float text_height = 0;  ///< pixels
  float scale = 1;        ///< factor of line widths
  std::vector<Text> texts;
  PixelRect event_mark;              ///< empty: no marker
  std::vector<PixelRect> key_marks;  ///< one per key item
  PixelRect bar;                     ///< the colour bar of the scale; empty: none
  std::vector<int> ticks;            ///< x of the tick marks below the bar
};

/// Lays out a frame of the given size. Text shrinks down to a legible minimum until at least half of the
/// height is left for the picture. `scale` is the number of pixels per screen pixel; the layout looks the
/// same at any scale. Throws InputError if it does not fit at the smallest text.
OverlayLayout lay_out(const Overlay& overlay, int width, int height, float scale = 1);

/// Returns the largest picture that fits all of these layouts. Use it for a sequence of frames, so that the
/// picture does not move.
PixelRect common_picture(std::span<const OverlayLayout> layouts);

/// Draws everything but the picture. The image must have the size used for the layout.
void draw_overlay(Image& image, const Overlay& overlay, const OverlayLayout& layout);

/// Composes a frame: background, the picture at its rectangle (it must have that size), the overlay. A
/// picture that is clipped by its border, such as a close-up, gets a thin frame.
Image compose_frame(const Image& picture, const PixelRect& place, const Overlay& overlay, int width,
                    int height, Rgba background = kWhite, float scale = 1);

/// Returns 1234567 as "1 234 567", with narrow spaces.
std::string group_digits(std::uint64_t n);
/// Returns a number with its noun: "1 face", "2 faces".
std::string counted(std::uint64_t n, const char* one, const char* many);

/// Returns a value as printed on a scale: whole from 1,000 to a million, otherwise three digits.
std::string short_number(double value);
/// Returns a share as a percentage: 0.125 as "12.5 %".
std::string percent(double share);

// Draws anti-aliased text into images on the CPU, identically on every machine.

/// Returns the path of the font file: $LRB_FONT if set (bold: $LRB_FONT_BOLD, else $LRB_FONT), else DejaVu
/// Sans as installed with this program, found by the build, or in the folders that distributions use. Throws
/// EnvironmentError that names the package to install.
std::string find_font(bool bold = false);

enum class Align { left, centre, right };

struct TextStyle {
  float height = 16;  ///< of the font (ascent to descent), pixels
  Rgba colour = kBlack;
  bool bold = false;
  Rgba halo = kTransparent;  ///< an outline that keeps text legible on any background
  float halo_width = 0;      ///< pixels
  Align align = Align::left;
};

struct TextSize {
  int width = 0;   ///< width of the line, pixels, rounded up
  int height = 0;  ///< ascent to descent, rounded up; depends only on the style
  int ascent = 0;  ///< height above the baseline, pixels
};

/// A font in its two weights. Reads the files once; const, and safe to share between threads.
class Font {
 public:
  /// Throws EnvironmentError if a file is missing or is not a TrueType font.
  Font();
  ~Font();
  Font(Font&&) noexcept;

  /// Measures one line of UTF-8.
  TextSize measure(std::string_view text, const TextStyle& style) const;
  /// Draws one line with its top at y; x is its left end, centre or right end, depending on style.align.
  void draw(Image& image, std::string_view text, int x, int y, const TextStyle& style) const;
  /// Breaks text at spaces so that no line is wider than `width`. A wider single word is broken inside.
  std::vector<std::string> wrap(std::string_view text, int width, const TextStyle& style) const;

 private:
  struct Faces;
  std::unique_ptr<Faces> faces_;
};

/// Returns the shared font; loads it on first use.
const Font& default_font();

/// Returns the next code point of UTF-8 text and moves past it; U+FFFD for bytes that are not UTF-8.
char32_t next_code_point(std::string_view& text);

}  // namespace lrb::render
