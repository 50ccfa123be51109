#pragma once
/// Draws text into images on the CPU: anti-aliased, the same on every machine.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/image.hpp"

namespace lrb::render {

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
  int ascent = 0;  ///< of these, above the base line
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
