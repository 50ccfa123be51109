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

/// A checksum computed at memory bandwidth: eight interleaved FNV-1a sums of 64-bit words, then FNV-1a over
/// the number of bytes, these sums and the remaining bytes. A change within one of the words always changes
/// the sum that contains it.
class WordSums {
 public:
  /// Adds the next bytes; the result does not depend on how they are divided.
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    size_ += size;
    // Complete the block of the last call.
    if (held_ > 0) {
      const std::size_t part = size < kBlock - held_ ? size : kBlock - held_;
      std::memcpy(rest_ + held_, bytes, part);
      held_ += part, bytes += part, size -= part;
      if (held_ < kBlock) return;
      add_block(rest_);
    }
    for (; size >= kBlock; bytes += kBlock, size -= kBlock) add_block(bytes);
    held_ = size;
    if (size > 0) std::memcpy(rest_, bytes, size);
  }
  std::uint64_t value() const {
    Fnv64 all;
    all.add_value(size_);
    all.add_bytes(lane_, sizeof lane_);
    all.add_bytes(rest_, held_);
    return all.value();
  }

 private:
  static constexpr std::size_t kLanes = 8, kBlock = kLanes * sizeof(std::uint64_t);
  static constexpr std::uint64_t kBasis = 0xcbf29ce484222325u;

  void add_block(const unsigned char* block) {
    std::uint64_t word[kLanes];
    std::memcpy(word, block, sizeof word);
    for (std::size_t k = 0; k < kLanes; ++k) lane_[k] = (lane_[k] ^ word[k]) * 0x100000001b3u;
  }

  std::uint64_t lane_[kLanes] = {kBasis,     kBasis + 1, kBasis + 2, kBasis + 3,
                                 kBasis + 4, kBasis + 5, kBasis + 6, kBasis + 7};
  std::uint64_t size_ = 0;
  std::size_t held_ = 0;  ///< number of bytes in rest_
  unsigned char rest_[kBlock] = {};
};

/// Returns the checksum of these bytes: see WordSums.
inline std::uint64_t fnv64_of_words(const void* data, std::size_t size) {
  WordSums sums;
  sums.add_bytes(data, size);
  return sums.value();
}

}  // namespace lrb
