#pragma once
/// How far two images differ, and a picture of it.

#include <cstdint>
#include <string>

#include "render/image.hpp"

namespace lrb::render {

/// What counts as noise between processors (measured; see README of the golden images): pixels in two
/// buckets.
struct ImageTolerance {
  int large = 8;                ///< a channel difference above this is large
  double large_share = 0.0005;  ///< at most this share of pixels may have one
  int small = 2;                ///< a difference of 1 .. small is noise of rounding
  double small_share = 0.15;    ///< at most this share of pixels may have one
};

struct ImageDifference {
  bool same_size = false;
  std::uint64_t pixels = 0;  ///< of either image; 0 unless same_size
  std::uint64_t equal = 0;
  std::uint64_t small = 0;   ///< largest channel difference in 1 .. tolerance.small
  std::uint64_t medium = 0;  ///< in between; counted with the small ones
  std::uint64_t large = 0;   ///< above tolerance.large
  int largest = 0;           ///< largest channel difference
  bool within(const ImageTolerance& tolerance = {}) const;
  /// One line: which tolerance failed and by how much, or that none did.
  std::string text(const ImageTolerance& tolerance = {}) const;
};

ImageDifference compare(const Image& expected, const Image& actual, const ImageTolerance& tolerance = {});

/// Per channel |expected - actual| times `gain`, on black; the union of both sizes, white where only one has
/// pixels.
Image difference_image(const Image& expected, const Image& actual, int gain = 16);

}  // namespace lrb::render
