#pragma once
/// Numbers as text that a page's script turns into arrays (packed.js): "u1:", "u2:", "u4:" or "f4:", for what
/// each of them is and its bytes, then base64 of them all, little-endian.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "render/base64.hpp"

namespace lrb::report {

using render::base64;

/// Packs the numbers into as few bytes each as the largest needs. The largest number of so many bytes stands
/// for kNull.
std::string packed(std::span<const std::uint32_t> numbers);
std::string packed(std::span<const float> numbers);

}  // namespace lrb::report
