#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace lrb {

/// FNV-1a, 64 bits (Fowler, Noll, Vo), for fingerprints of results and checksums of files. Hashes the bytes
/// in memory. lrbscope's formats and fingerprints are little-endian, like all supported machines.
class Fnv64 {
 public:
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) h_ = (h_ ^ bytes[i]) * 0x100000001b3u;
  }
  template <class T>
  void add_value(const T& value) {
    add_bytes(&value, sizeof value);
  }
  /// Adds the length, then the elements.
  template <class T>
  void add_array(const std::vector<T>& v) {
    add_value(static_cast<std::uint64_t>(v.size()));
    add_bytes(v.data(), v.size() * sizeof(T));
  }
  std::uint64_t value() const { return h_; }

 private:
  std::uint64_t h_ = 0xcbf29ce484222325u;
};

/// Returns a checksum computed at memory bandwidth: eight interleaved FNV-1a sums of 64-bit words, then
/// FNV-1a over these sums and the remaining bytes. A change within one of these words always changes
/// the sum that contains it.
inline std::uint64_t fnv64_of_words(const void* data, std::size_t size) {
  constexpr std::size_t kLanes = 8, kWord = sizeof(std::uint64_t);
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t lane[kLanes];
  for (std::size_t k = 0; k < kLanes; ++k) lane[k] = 0xcbf29ce484222325u + k;
  std::size_t at = 0;
  for (; at + kLanes * kWord <= size; at += kLanes * kWord) {
    std::uint64_t word[kLanes];
    std::memcpy(word, bytes + at, sizeof word);
    for (std::size_t k = 0; k < kLanes; ++k) lane[k] = (lane[k] ^ word[k]) * 0x100000001b3u;
  }
  Fnv64 all;
  all.add_value(static_cast<std::uint64_t>(size));
  all.add_bytes(lane, sizeof lane);
  all.add_bytes(bytes + at, size - at);
  return all.value();
}

}  // namespace lrb
