#pragma once
/// Images as PNG, with what is needed to make them again written inside.

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

/// Opaque images are stored as RGB, others as RGBA.
std::vector<std::uint8_t> encode_png(const Image& image, const PngOptions& options = {});

struct DecodedPng {
  Image image;
  std::vector<PngText> text;
  double dpi = 0;  ///< 0: none given
};
/// Pixels of a picture at most, unless fewer are expected: 0.5 GB of them.
inline constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 27;

/// Throws InputError with `name` in it if the bytes are no PNG, or a damaged one, or one of more pixels than
/// `most_pixels`, or one whose data are fewer or more than its pixels. Memory is taken for the pixels alone, and only if so
/// many can be in so few bytes.
DecodedPng decode_png(std::span<const std::uint8_t> bytes, const std::string& name = "PNG",
                      std::uint64_t most_pixels = kMostPixels);

/// Whole or not at all (AtomicFile): no half-written picture is ever seen under its name. Throws InputError
/// if the path is at fault, EnvironmentError if the machine is.
void write_png(const Image& image, const std::string& path, const PngOptions& options = {});
/// Throws InputError if the file cannot be read.
DecodedPng read_png(const std::string& path, std::uint64_t most_pixels = kMostPixels);

}  // namespace lrb::render
