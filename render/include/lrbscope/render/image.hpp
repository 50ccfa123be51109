#pragma once
/// Images as plain values.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <lrbscope/render/style.hpp>

namespace lrb::render {

// The only conversions from double to float. Everything before is Eigen in double, precise enough for
// decisions; everything after is glm, as OpenGL and the shaders use it. Each number is rounded once, to
// nearest.

using ByteColour = glm::u8vec4;  ///< red, green, blue, alpha; straight (not premultiplied)

inline float to_float(double x) {
  return static_cast<float>(x);
}
inline glm::vec2 to_float(const Eigen::Vector2d& v) {
  return {to_float(v.x()), to_float(v.y())};
}
inline glm::vec3 to_float(const Eigen::Vector3d& v) {
  return {to_float(v.x()), to_float(v.y()), to_float(v.z())};
}

inline ByteColour to_bytes(Rgba c) {
  return {c.r, c.g, c.b, c.a};
}
/// Returns the colour with channels in [0, 1].
inline glm::vec4 to_unit(Rgba c) {
  return glm::vec4(to_bytes(c)) / 255.0F;
}

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
  /// Throws InputError unless both sizes are in 1 .. kMaxSide.
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

  /// Blends one pixel; no effect outside the image.
  void blend(int x, int y, Rgba colour, int coverage = 255);
  void fill(const PixelRect& r, Rgba colour);
  /// Draws a frame of `thickness` pixels just inside the rectangle.
  void stroke(const PixelRect& r, Rgba colour, int thickness = 1);
  /// Alpha-blends another image with its top left corner at (x, y).
  void paste(const Image& image, int x, int y);

  friend bool operator==(const Image&, const Image&) = default;

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }

  int width_ = 0, height_ = 0;
  std::vector<Rgba> pixels_;
};

/// Returns the FNV-1a hash (64 bits) of size and pixels.
std::uint64_t hash(const Image& image);

// Compares images and draws their difference.

/// Limits of the differences that count as noise between processors (measured; see docs/golden.md). Pixels
/// are classed as small or large differences.
struct ImageTolerance {
  int large = 8;                ///< a channel difference above this is large
  double large_share = 0.0005;  ///< maximum share of pixels with one
  int small = 2;                ///< a difference of 1 .. small is rounding noise
  double small_share = 0.15;    ///< maximum share of pixels with one

  friend bool operator==(const ImageTolerance&, const ImageTolerance&) = default;
};

struct ImageDifference {
  bool same_size = false;
  std::uint64_t pixels = 0;  ///< number of pixels of the larger image; 0 unless same_size
  std::uint64_t equal = 0;
  std::uint64_t small = 0;   ///< pixels with maximum channel difference in 1 .. tolerance.small
  std::uint64_t medium = 0;  ///< pixels between small and large; counted as small
  std::uint64_t large = 0;   ///< pixels above tolerance.large
  int largest = 0;           ///< maximum channel difference
  bool within(const ImageTolerance& tolerance = {}) const;
  /// Returns one line: the exceeded tolerance and by how much, or that none was exceeded.
  std::string text(const ImageTolerance& tolerance = {}) const;
};

ImageDifference compare(const Image& expected, const Image& actual, const ImageTolerance& tolerance = {});

/// Returns |expected - actual| times `gain` per channel, on black. As wide as the wider and as high as the
/// higher image; white where only one has pixels.
Image difference_image(const Image& expected, const Image& actual, int gain = 16);

// Writes and reads images as PNG, with text chunks that state how to reproduce them.

/// Keyword (1 to 79 Latin-1 characters) and value of a tEXt chunk. Values beyond Latin-1 are written as iTXt.
using PngText = std::pair<std::string, std::string>;

struct PngOptions {
  std::vector<PngText> text;
  double dpi = 0;  ///< written as pHYs; 0: omitted
};

/// Encodes an image: opaque ones as RGB, others as RGBA.
std::vector<std::uint8_t> encode_png(const Image& image, const PngOptions& options = {});

struct DecodedPng {
  Image image;
  std::vector<PngText> text;
  double dpi = 0;  ///< 0: not given
};
/// Default limit on the pixels of a picture that is read: 0.5 GB.
inline constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 27;

/// Decodes a PNG. Throws InputError with `name` in it if the bytes are not a PNG, are damaged, have more than
/// `max_pixels` pixels, or contain more or less data than their pixels take. Allocates memory for the pixels
/// only, and only if the compressed bytes can expand to that many.
DecodedPng decode_png(std::span<const std::uint8_t> bytes, const std::string& name = "PNG",
                      std::uint64_t max_pixels = kMaxPixels);

/// Writes a picture completely or not at all (AtomicFile), so that no partial file appears under its name.
/// Throws InputError for a bad path, EnvironmentError for a failure of the machine.
void write_png(const Image& image, const std::string& path, const PngOptions& options = {});
/// Reads a picture. Throws InputError if the file cannot be read.
DecodedPng read_png(const std::string& path, std::uint64_t max_pixels = kMaxPixels);

}  // namespace lrb::render
