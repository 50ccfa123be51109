#pragma once
/// Pictures as plain values.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/colour.hpp"

namespace lrb::render {

/// A rectangle of pixels: x to the right, y down, from the top left corner of an image.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
  int right() const { return x + width; }
  int bottom() const { return y + height; }
  bool contains(const PixelRect& r) const {
    return r.x >= x && r.y >= y && r.right() <= right() && r.bottom() <= bottom();
  }
  bool overlaps(const PixelRect& r) const {
    return x < r.right() && r.x < right() && y < r.bottom() && r.y < bottom();
  }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

class Image {
 public:
  Image() = default;
  /// Throws InputError unless both sizes lie in 1 .. kMaxSide.
  Image(int width, int height, Rgba fill = kWhite);

  static constexpr int kMaxSide = 32768;

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return pixels_.empty(); }
  PixelRect rect() const { return {0, 0, width_, height_}; }

  Rgba& at(int x, int y) { return pixels_[index(x, y)]; }
  const Rgba& at(int x, int y) const { return pixels_[index(x, y)]; }
  /// The pixels row by row from the top, each row from the left.
  std::vector<Rgba>& pixels() { return pixels_; }
  const std::vector<Rgba>& pixels() const { return pixels_; }
  bool opaque() const;  ///< every alpha is 255

  /// Paints one pixel; outside the image does nothing.
  void blend(int x, int y, Rgba colour, int coverage = 255);
  void fill(const PixelRect& r, Rgba colour);
  /// Draws a frame of `thickness` pixels just inside the rectangle.
  void stroke(const PixelRect& r, Rgba colour, int thickness = 1);
  /// Blends another image by its alpha, with its top left corner at (x, y).
  void paste(const Image& image, int x, int y);

  friend bool operator==(const Image&, const Image&) = default;

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }

  int width_ = 0, height_ = 0;
  std::vector<Rgba> pixels_;
};

/// Returns the FNV-1a hash (64 bits) of size and pixels.
std::uint64_t hash(const Image& image);

}  // namespace lrb::render
