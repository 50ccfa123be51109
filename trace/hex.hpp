#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lrb::trace {

/// 16 hexadecimal digits: how files hold 64-bit hashes (JSON's numbers are doubles to many readers).
inline std::string to_hex(std::uint64_t value) {
  std::string out(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) out[i] = "0123456789abcdef"[value & 15];
  return out;
}

/// The reverse; exactly 16 lower-case digits, else nothing.
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
