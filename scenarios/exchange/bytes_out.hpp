#pragma once

#include <bit>
#include <cstring>
#include <string>

namespace lrb::exchange {

/// Appends a number's bytes, little-endian.
template <class T>
void append(std::string& out, T value) {
  static_assert(std::endian::native == std::endian::little, "swap the bytes first");
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

}  // namespace lrb::exchange
