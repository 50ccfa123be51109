#pragma once
/// What every frame says about itself: title, event, counters, colour key, scale. It gets strips of its own
/// above and below the picture, so that nothing overlaps; text wraps rather than being cut off.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/image.hpp"

namespace lrb::render {

struct LegendItem {
  enum class Mark : std::uint8_t { solid, translucent, line, dashed, point } mark = Mark::solid;
  Rgba colour;
  std::string text;
};

/// The meaning of viridis in this picture.
struct ScaleBar {
  std::string text;          ///< quantity and unit
  double low = 0, high = 1;  ///< values at both ends
};

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
  bool empty() const { return title.empty() && event.empty() && counters.empty() && key.empty() && !scale; }
};

/// Where each part goes.
struct OverlayLayout {
  struct Text {
    PixelRect box;
    std::string text;
    bool bold = false, faint = false;
  };
  PixelRect picture;      ///< what is left for the picture
  float text_height = 0;  ///< pixels
  float scale = 1;        ///< of lines
  std::vector<Text> texts;
  PixelRect event_mark;              ///< empty: none
  std::vector<PixelRect> key_marks;  ///< one per key item
  PixelRect bar;                     ///< the scale's colour bar itself; empty: none
};

/// Lays out for a frame of the given size. Text shrinks, down to what can still be read, until at least half
/// of the height is left for the picture. `scale`: pixels per pixel of a screen; the same frame with more of
/// them looks the same. Throws InputError if it does not fit even so.
OverlayLayout lay_out(const Overlay& overlay, int width, int height, float scale = 1);

/// The largest picture that all these layouts leave free: what a sequence of frames should use, so that the
/// picture stands still.
PixelRect common_picture(std::span<const OverlayLayout> layouts);

/// Draws everything but the picture; the image must have the size that was laid out for.
void draw_overlay(Image& image, const Overlay& overlay, const OverlayLayout& layout);

/// A whole frame: background, the picture in its place (it must have the rectangle's size), the overlay. A
/// picture that runs over its rim, such as a close-up, gets a thin frame.
Image compose_frame(const Image& picture, const PixelRect& place, const Overlay& overlay, int width,
                    int height, Rgba background = kWhite, float scale = 1);

/// 1234567 as "1 234 567", with narrow spaces.
std::string group_digits(std::uint64_t n);

/// A value for a scale: short, at most four digits.
std::string short_number(double value);

}  // namespace lrb::render
