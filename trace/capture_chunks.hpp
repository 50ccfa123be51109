#pragma once
/// The chunks of a capture: docs/capture.md describes the format.
///
/// A file is untrusted. Every count is compared with the bytes left in its chunk before anything is
/// allocated, so that memory is bounded by a multiple of the file's size; that of instances is by a number.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lrb::capture {

inline constexpr std::string_view kMagic("LRBCAP\r\n", 8);
inline constexpr std::size_t kFileHeader = 16, kChunkHeader = 24;

bool is_chunk_name(std::string_view name);
std::string text(std::uint64_t number);

/// The current chunk of a file or of a stream, whose numbers are read in order.
class Chunk {
 public:
  Chunk(std::span<const std::byte> bytes, const std::string& name);

 protected:
  /// Throws an InputError: the name, the location and the fault.
  [[noreturn]] void fail(const std::string& what) const;
  void require(bool holds, const char* what) const {
    if (!holds) fail(what);
  }
  /// Reads the header of the file, at the begin of bytes_.
  void read_header();
  /// Reads the header of the next chunk. Returns false if the chunk is not whole.
  bool open_next();
  void skip_content() { at_ = end_; }

  std::size_t left() const { return end_ - at_; }
  template <class Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number>);
    require(left() >= sizeof(Number), "the content ends too early; the file is damaged");
    Number x;
    std::memcpy(&x, bytes_.data() + at_, sizeof x);
    at_ += sizeof x;
    return x;
  }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }
  template <class Number>
  std::vector<Number> numbers(std::uint64_t count) {
    require(count <= left() / sizeof(Number),
            "the content is smaller than its counts say; the file is damaged");
    std::vector<Number> out(count);
    if (count != 0) std::memcpy(out.data(), bytes_.data() + at_, count * sizeof(Number));
    at_ += count * sizeof(Number);
    return out;
  }
  std::string characters(std::uint64_t count);

  std::span<const std::byte> bytes_;
  std::uint64_t base_ = 0;        ///< offset of bytes_ in a stream
  std::size_t at_ = 0, end_ = 0;  ///< in bytes_: of the next number, and the end of the chunk

  std::string kind_;
  std::uint32_t version_ = 0;
  std::uint64_t ticks_ = 0;
  std::uint32_t query_ = 0;  ///< its number; 0: none
  std::uint64_t event_ = 0;  ///< for messages, from 1; 0: none

 private:
  std::string name_;
  std::size_t begin_ = 0, number_ = 0;  ///< of the chunk
};

}  // namespace lrb::capture
