#pragma once
/// Draws what every frame says about itself: title, event, counters, colour key, scale. These get strips of
/// their own above and below the picture, so that nothing overlaps; text is wrapped, not cut off.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/image.hpp"
#include "render/style.hpp"

namespace lrb::render {

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

}  // namespace lrb::render
