#pragma once
/// Measures how far two images differ, and draws it.

#include <cstdint>
#include <string>

#include "render/image.hpp"

namespace lrb::render {

/// The differences that count as noise between processors (measured; see docs/golden.md). Pixels are sorted
/// into small and large differences.
struct ImageTolerance {
  int large = 8;                ///< a channel difference above this is large
  double large_share = 0.0005;  ///< at most this share of pixels may have one
  int small = 2;                ///< a difference of 1 .. small is noise of rounding
  double small_share = 0.15;    ///< at most this share of pixels may have one

  friend bool operator==(const ImageTolerance&, const ImageTolerance&) = default;
};

struct ImageDifference {
  bool same_size = false;
  std::uint64_t pixels = 0;  ///< number of pixels of either image; 0 unless same_size
  std::uint64_t equal = 0;
  std::uint64_t small = 0;   ///< number of pixels whose largest channel difference is in 1 .. tolerance.small
  std::uint64_t medium = 0;  ///< number between small and large; counted with the small ones
  std::uint64_t large = 0;   ///< number of pixels above tolerance.large
  int largest = 0;           ///< largest channel difference
  bool within(const ImageTolerance& tolerance = {}) const;
  /// Returns one line: which tolerance was exceeded and by how much, or that none was.
  std::string text(const ImageTolerance& tolerance = {}) const;
};

ImageDifference compare(const Image& expected, const Image& actual, const ImageTolerance& tolerance = {});

/// Returns |expected - actual| times `gain` per channel, on black. It is as wide and high as either image;
/// white where only one has pixels.
Image difference_image(const Image& expected, const Image& actual, int gain = 16);

}  // namespace lrb::render
