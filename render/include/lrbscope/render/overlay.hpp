#pragma once
/// Draws what every frame says about itself: title, event, counters, colour key, scale. These get strips of
/// their own above and below the picture, so that nothing overlaps; text is wrapped, not cut off.

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

// Puts pictures side by side in one image: figures with (a), (b), (c), or the whole beside a close-up.

struct Panel {
  Image image;
  std::string caption;  ///< below the panel, after its letter; may be empty
};

struct MontageOptions {
  int columns = 0;      ///< 0: the number that brings the montage closest to 4:3
  int gutter = -1;      ///< between and around panels, pixels; -1: a twenty-fourth of a panel's smaller side
  bool letters = true;  ///< (a), (b), ... below each panel
  bool frame = false;   ///< a thin line round each panel
  float text_height = 0;  ///< pixels; 0: a twentieth of the panels' height, at least 12
  Rgba background = kWhite;
  StyleName style = StyleName::screen;  ///< of captions and frames
};

struct MontageLayout {
  int width = 0, height = 0;
  std::vector<PixelRect> panels;                ///< where the images go
  std::vector<PixelRect> captions;              ///< room below each
  std::vector<std::vector<std::string>> lines;  ///< their text, wrapped
  float text_height = 0;
};

/// Lays panels out row by row. Images of different sizes are centred in cells; a column has one width, a row
/// one height. Throws InputError without panels.
MontageLayout lay_out(const std::vector<Panel>& panels, const MontageOptions& options = {});
Image montage(const std::vector<Panel>& panels, const MontageOptions& options = {});

/// Returns "(a)" .. "(z)", "(aa)" ...
std::string panel_letter(std::size_t index);

struct LegendItem {
  enum class Mark : std::uint8_t { solid, translucent, line, dashed, point } mark = Mark::solid;
  Rgba colour;
  std::string text;
};

/// What the colours of viridis mean in this picture.
struct ScaleBar {
  std::string text;          ///< quantity and unit
  double low = 0, high = 1;  ///< values at both ends
  bool log = false;          ///< logarithmic, with ticks at 1, 2 and 5 times powers of ten; low > 0
};

/// Returns the place of a value on a scale, from 0 at the low end to 1 at the high one; beyond them, the
/// ends.
double place_on(const ScaleBar& scale, double value);

struct OverlayCounter {
  std::string name, value;
};

struct Overlay {
  std::string title;  ///< bold, first line
  std::string event;  ///< second line, with a mark in event_colour
  Rgba event_colour = kTransparent;
  std::vector<OverlayCounter> counters;
  std::vector<LegendItem> key;
  std::optional<ScaleBar> scale;
  StyleName style = StyleName::screen;
  bool empty() const { return title.empty() && event.empty() && counters.empty() && key.empty() && !scale; }
};

/// The place of each part.
struct OverlayLayout {
  struct Text {
    PixelRect box;
    std::string text;
    bool bold = false, faint = false;
  };
  PixelRect picture;      ///< the room that is left for the picture
  float text_height = 0;  ///< pixels
  float scale = 1;        ///< factor of line widths
  std::vector<Text> texts;
  PixelRect event_mark;              ///< empty: none
  std::vector<PixelRect> key_marks;  ///< one per key item
  PixelRect bar;                     ///< the scale's colour bar itself; empty: none
  std::vector<int> ticks;            ///< x of the marks below the bar
};

/// Lays out for a frame of the given size. Text shrinks, as far as it stays legible, until at least half of
/// the height is left for the picture. `scale` is the number of pixels per pixel of a screen; the same frame
/// with more of them looks the same. Throws InputError if it does not fit even so.
OverlayLayout lay_out(const Overlay& overlay, int width, int height, float scale = 1);

/// Returns the largest picture that all these layouts leave room for. A sequence of frames should use it, so
/// that the picture stands still.
PixelRect common_picture(std::span<const OverlayLayout> layouts);

/// Draws everything but the picture; the image must have the size that was laid out for.
void draw_overlay(Image& image, const Overlay& overlay, const OverlayLayout& layout);

/// Composes a whole frame: background, the picture in its place (it must have the rectangle's size), the
/// overlay. A picture whose content runs over its rim, such as a close-up, gets a thin frame.
Image compose_frame(const Image& picture, const PixelRect& place, const Overlay& overlay, int width,
                    int height, Rgba background = kWhite, float scale = 1);

/// Returns 1234567 as "1 234 567", with narrow spaces.
std::string group_digits(std::uint64_t n);
/// Returns a number with its noun: "1 face", "2 faces".
std::string counted(std::uint64_t n, const char* one, const char* many);

/// Returns a value as a scale shows it: with four digits at most.
std::string short_number(double value);

// Draws text into images on the CPU: anti-aliased, the same on every machine.

/// Returns the path of the font's file: $LRB_FONT if set (for the bold font $LRB_FONT_BOLD, else $LRB_FONT),
/// else DejaVu Sans where the build found it, or where distributions put it. Throws EnvironmentError that
/// says what to install.
std::string find_font(bool bold = false);

enum class Align { left, centre, right };

struct TextStyle {
  float height = 16;  ///< of the font (ascent to descent), pixels
  Rgba colour = kBlack;
  bool bold = false;
  Rgba halo = kTransparent;  ///< an outline that keeps text legible on anything
  float halo_width = 0;      ///< pixels
  Align align = Align::left;
};

struct TextSize {
  int width = 0;   ///< width that the line takes, in pixels, rounded up
  int height = 0;  ///< ascent to descent, rounded up: the same for every text of a style
  int ascent = 0;  ///< pixels of the height above the base line
};

/// A font in its two weights. Reads the files once; is const and can be shared between threads.
class Font {
 public:
  /// Throws EnvironmentError if a file is missing or is no TrueType font.
  Font();
  ~Font();
  Font(Font&&) noexcept;

  /// Measures one line of UTF-8.
  TextSize measure(std::string_view text, const TextStyle& style) const;
  /// Draws one line with the top of its height at y; x is its left end, middle or right end as style.align
  /// says.
  void draw(Image& image, std::string_view text, int x, int y, const TextStyle& style) const;
  /// Breaks text at spaces so that no line is wider than `width`; breaks inside a word that is wider by
  /// itself.
  std::vector<std::string> wrap(std::string_view text, int width, const TextStyle& style) const;

 private:
  struct Faces;
  std::unique_ptr<Faces> faces_;
};

/// Returns the font that everybody uses; loads it on first use.
const Font& default_font();

/// Returns the next code point of UTF-8 text and moves past it; U+FFFD for bytes that are not UTF-8.
char32_t next_code_point(std::string_view& text);

}  // namespace lrb::render
