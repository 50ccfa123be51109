#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lrb::trace {

/// Returns a number as 16 hexadecimal digits. Files hold 64-bit hashes so, because many readers take JSON's
/// numbers for doubles.
inline std::string to_hex(std::uint64_t value) {
  std::string out(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) out[i] = "0123456789abcdef"[value & 15];
  return out;
}

/// Reads what to_hex() returned; nothing unless it is exactly 16 lower-case digits.
inline std::optional<std::uint64_t> from_hex(std::string_view text) {
  if (text.size() != 16) return std::nullopt;
  std::uint64_t value = 0;
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit && (c < 'a' || c > 'f')) return std::nullopt;
    value = value << 4 | static_cast<std::uint64_t>(digit ? c - '0' : c - 'a' + 10);
  }
  return value;
}

}  // namespace lrb::trace
