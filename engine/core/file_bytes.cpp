#include "engine/core/file_bytes.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "engine/core/error.hpp"

namespace lrb {
namespace {

std::string escaped(std::string_view text, bool keep_high) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte >= 0x20 && byte < 0x7f) || (keep_high && byte >= 0x80)) {
      out += c;
    } else {
      out += {'\\', 'x', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out;
}

[[noreturn]] void cannot_read(const std::string& path, const std::string& why) {
  throw InputError(printable_name(path) + ": " + why);
}

}  // namespace

std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    cannot_read(path, "found a directory, expected a file; name a file in it");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) {
    const int reason = errno;
    if (reason == ENOENT) cannot_read(path, "no such file; check the path");
    cannot_read(path, std::string("cannot be opened (") + std::strerror(reason) + "); check its permissions");
  }
  // /dev/zero never ends. Pipes may be read: whoever fills one decides how much comes.
  const auto kind = std::filesystem::status(path, ignored).type();
  if (kind == std::filesystem::file_type::character || kind == std::filesystem::file_type::block)
    cannot_read(path, "found a device, expected a file; copy what is on it into a file");
  std::string bytes;
  const auto size = std::filesystem::file_size(path, ignored);
  if (!ignored) bytes.reserve(size + 1);  // pipes have no size and grow as they come
  static constexpr std::size_t kChunk = std::size_t{1} << 18;
  for (;;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kChunk);
    const std::size_t got = std::fread(bytes.data() + before, 1, kChunk, file.get());
    bytes.resize(before + got);
    if (got == kChunk) continue;
    if (std::ferror(file.get())) cannot_read(path, "reading failed; check the disk or copy the file again");
    return bytes;
  }
}

std::string quoted(std::string_view text, std::size_t limit) {
  const bool cut = text.size() > limit;
  return std::string(1, '\'').append(escaped(text.substr(0, limit), false)).append(cut ? "...'" : "'");
}

std::string printable_name(std::string_view name) {
  return escaped(name, true);
}

}  // namespace lrb
