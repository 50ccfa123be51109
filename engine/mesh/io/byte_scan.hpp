#pragma once
/// Reads numbers from a binary file's bytes.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace lrb {

/// Returns the number stored at `from`, which need not be aligned.
template <class T>
T load(const char* from, std::endian order) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

}  // namespace lrb
