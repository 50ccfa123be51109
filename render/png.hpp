#pragma once
/// Writes and reads images as PNG, with text inside that says how to make them again.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/image.hpp"

namespace lrb::render {

/// Keyword (1 to 79 Latin-1 characters) and value of a tEXt chunk; values beyond Latin-1 go into an iTXt
/// chunk.
using PngText = std::pair<std::string, std::string>;

struct PngOptions {
  std::vector<PngText> text;
  double dpi = 0;  ///< written as pHYs; 0: left out
};

/// Encodes an image: opaque ones as RGB, others as RGBA.
std::vector<std::uint8_t> encode_png(const Image& image, const PngOptions& options = {});

struct DecodedPng {
  Image image;
  std::vector<PngText> text;
  double dpi = 0;  ///< 0: none given
};
/// The largest number of pixels of a picture that is read, unless the caller expects fewer: 0.5 GB of them.
inline constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 27;

/// Decodes a PNG. Throws InputError with `name` in it if the bytes are not a PNG, are damaged, hold more than
/// `most_pixels` pixels, or hold more or less data than their pixels take. Takes memory only for the pixels,
/// and only if so many can be in so few bytes.
DecodedPng decode_png(std::span<const std::uint8_t> bytes, const std::string& name = "PNG",
                      std::uint64_t most_pixels = kMostPixels);

/// Writes a picture whole or not at all (AtomicFile), so that a half-written one is never seen under its
/// name. Throws InputError if the path is at fault, EnvironmentError if the machine is.
void write_png(const Image& image, const std::string& path, const PngOptions& options = {});
/// Reads a picture. Throws InputError if the file cannot be read.
DecodedPng read_png(const std::string& path, std::uint64_t most_pixels = kMostPixels);

}  // namespace lrb::render
