#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lrb::report {

using PngBytes = std::vector<std::uint8_t>;

/// What a page of pictures may weigh. Browsers hold a data URI several times over while they parse the page;
/// beyond some 15 MB pages open with a delay that one notices.
inline constexpr std::size_t kInlineBudget = 15'000'000;

/// Pictures as data URIs that can stand in a page. While all of them fit into the budget they stay what they
/// are; else they become JPEGs, and if need be at half the size, again and again. The PNGs beside the page
/// keep every pixel.
struct InlinedImages {
  std::vector<std::string> uris;
  std::string note;  ///< what was done to them, for the page; empty if nothing
};
InlinedImages inline_pngs(const std::vector<PngBytes>& pngs, std::size_t budget = kInlineBudget);

/// "data:TYPE;base64,..."
std::string data_uri(const std::string& type, const std::uint8_t* bytes, std::size_t size);

}  // namespace lrb::report
