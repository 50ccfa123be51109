#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lrb::render {

/// Returns bytes as text of RFC 4648, with padding: how pictures stand inside SVG and HTML.
std::string base64(const std::uint8_t* bytes, std::size_t size);

}  // namespace lrb::render
