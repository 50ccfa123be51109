#pragma once
/// Text, drawn into images on the CPU: anti-aliased, the same on every machine.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/image.hpp"

namespace lrb::render {

/// The font's file: $LRB_FONT if set (for the bold one $LRB_FONT_BOLD, else $LRB_FONT), else DejaVu Sans
/// where it was found when we were built, or where distributions put it. Throws EnvironmentError with what to
/// install.
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
  int width = 0;   ///< pixels that the line's advance takes, rounded up
  int height = 0;  ///< ascent to descent, rounded up: the same for every text of a style
  int ascent = 0;  ///< of these, above the base line
};

/// A font in its two weights. Reads the files once; const and shareable between threads.
class Font {
 public:
  /// Throws EnvironmentError if a file is missing or is no TrueType font.
  Font();
  ~Font();
  Font(Font&&) noexcept;

  /// One line of UTF-8.
  TextSize measure(std::string_view text, const TextStyle& style) const;
  /// Draws one line with the top of its height at y; x is its left end, middle or right end as style.align
  /// says.
  void draw(Image& image, std::string_view text, int x, int y, const TextStyle& style) const;
  /// Breaks at spaces so that no line is wider than `width`; a word that is wider alone is broken inside.
  std::vector<std::string> wrap(std::string_view text, int width, const TextStyle& style) const;

 private:
  struct Faces;
  std::unique_ptr<Faces> faces_;
};

/// The font for everyone, loaded on first use.
const Font& default_font();

/// Next code point of UTF-8 text, moved past it; U+FFFD for what is no UTF-8.
char32_t next_code_point(std::string_view& text);

}  // namespace lrb::render
