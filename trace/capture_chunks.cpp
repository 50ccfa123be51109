#include "trace/capture_chunks.hpp"

#include <algorithm>
#include <bit>

#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::capture {
namespace {

static_assert(std::endian::native == std::endian::little, "captures are read in the order of their writers");

constexpr std::uint32_t kVersion = 1, kByteOrder = 0x01020304, kOtherByteOrder = 0x04030201;

/// Returns what a file that is not a capture looks like.
std::string content_of(std::string_view file) {
  if (file.empty()) return "an empty file";
  const std::string_view begin = file.substr(0, 256);
  if (begin.starts_with("\x1f\x8b")) return "a gzip file (unpack it)";
  if (begin.starts_with('{') || begin.starts_with('[')) return "JSON";
  const bool is_text = std::all_of(begin.begin(), begin.end(), [](char c) {
    return static_cast<unsigned char>(c) >= ' ' || c == '\n' || c == '\r' || c == '\t';
  });
  return (is_text ? "text: " : "other bytes: ") + in_quotes(begin.substr(0, begin.find('\n')), 20);
}

}  // namespace

bool is_capture(std::span<const std::byte> bytes) {
  return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

bool is_chunk_name(std::string_view name) {
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

std::string text(std::uint64_t number) {
  return std::to_string(number);
}

Chunk::Chunk(std::span<const std::byte> bytes, const std::string& name)
    : bytes_(bytes), name_(printable_name(name)) {}

void Chunk::fail(const std::string& what) const {
  std::string where = name_ + ":";
  if (number_ != 0)
    where += " chunk " + text(number_) + " (" + kind_ + " at byte " + text(base_ + begin_) + ")";
  if (query_ != 0) where += (number_ != 0 ? ", query " : " query ") + text(query_);
  if (event_ != 0) where += ", event " + text(event_);
  throw InputError(where + (number_ != 0 || query_ != 0 ? ": " : " ") + what);
}

void Chunk::read_header() {
  const auto file = std::string_view(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
  if (!is_capture(bytes_))
    fail("expected a capture (LRBCAP ...), found " + content_of(file) +
         "; record one with lrbscope_capture.h");
  if (bytes_.size() < kFileHeader)
    fail("expected 16 bytes of file header, found " + text(bytes_.size()) + "; record the capture again");
  end_ = kFileHeader;
  at_ = kMagic.size();
  const auto version = number<std::uint32_t>(), order = number<std::uint32_t>();
  if (order == kOtherByteOrder)
    fail("expected little-endian numbers, found a capture of a big-endian machine; record it on another");
  if (order != kByteOrder) fail("expected the byte order mark 01020304, found another; the file is damaged");
  if (version != kVersion)
    fail("expected version 1 of the format, found " + text(version) +
         "; use an lrbscope_capture.h and an lrbscope that belong together");
}

std::string Chunk::characters(std::uint64_t count) {
  const std::vector<char> read = numbers<char>(count);
  return {read.begin(), read.end()};
}

bool Chunk::open_next() {
  begin_ = at_, end_ = bytes_.size(), ++number_, query_ = 0, event_ = 0;
  kind_ = characters(4);
  if (kind_ == kMagic.substr(0, 4)) fail("a second capture begins here; give each program a file of its own");
  if (!is_chunk_name(kind_)) {
    kind_ = in_quotes(kind_);
    fail("expected a chunk name of four letters; the file is damaged");
  }
  version_ = u32();
  const std::uint64_t size = u64();
  ticks_ = u64();
  if (size > left()) {
    at_ = begin_;
    return false;
  }
  end_ = at_ + size;
  return true;
}

}  // namespace lrb::capture
