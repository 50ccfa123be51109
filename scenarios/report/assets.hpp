#pragma once
/// Numbers as text that a page's script turns into arrays (scene_run.js): "u1:", "u2:", "u4:" or "f4:", for
/// what each of them is and its bytes, then base64 of them all, little-endian.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/canvas.hpp"

namespace lrb::report {

using PngBytes = std::vector<std::uint8_t>;

/// The size of a page's pictures, in bytes, that is still fine. Browsers hold several copies of a data URI
/// while they parse a page; pages beyond some 15 MB open with a delay that one notices.
inline constexpr std::size_t kInlineBudget = 15'000'000;

/// Pictures as data URIs that can stand in a page. If all of them fit into the budget they are left as they
/// are; otherwise they become JPEGs, if need be at half the size, and half of that again. The PNG files
/// beside the page keep every pixel.
struct InlinedImages {
  std::vector<std::string> uris;
  std::string note;  ///< what was done to them, for the page; empty if nothing
};
InlinedImages inline_pngs(const std::vector<PngBytes>& pngs, std::size_t budget = kInlineBudget);

/// Returns "data:TYPE;base64,...".
std::string data_uri(const std::string& type, const std::uint8_t* bytes, std::size_t size);

using render::base64;

/// Returns HTML: each "{}" of a pattern becomes the next of the texts, escaped, each "{!}" the next one as it
/// is.
std::string fill(std::string_view pattern, std::initializer_list<std::string_view> texts);

/// Returns a template with each "{{key}}" replaced by its text, in one pass: keys inside the texts are left
/// alone.
std::string filled(std::string_view shape,
                   std::initializer_list<std::pair<std::string_view, std::string_view>> texts);

/// Packs the numbers into as few bytes each as the largest needs. The largest number of so many bytes stands
/// for kNull.
std::string packed(std::span<const std::uint32_t> numbers);
std::string packed(std::span<const float> numbers);

}  // namespace lrb::report
