#include "engine/core/file_bytes.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <sys/vfs.h>

#include "engine/core/error.hpp"

namespace lrb {
namespace {

std::string escaped(std::string_view text, bool keep_high) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    // Printable ASCII as it is. Bytes from 0x80 may be UTF-8, and are kept on request. Others as \xhh.
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

/// Returns true if a FIFO has a name. A pipe without one, as <(...) and | make it, is filled by the process
/// at its other end. Opening a named one blocks until somebody writes to it.
bool has_name(const char* fifo) {
  constexpr long kPipeFileSystem = 0x50495045;  // PIPEFS_MAGIC
  struct statfs where {};
  return statfs(fifo, &where) != 0 || static_cast<long>(where.f_type) != kPipeFileSystem;
}

[[noreturn]] void too_large(const std::string& path, std::uint64_t most) {
  cannot_read(path, "found more than " + std::to_string(most) +
                        " bytes, which is the most for a file of this kind; is it the right one?");
}

}  // namespace

std::string_view what_is_no_file(const std::string& path) {
  using Kind = std::filesystem::file_type;
  std::error_code ignored;
  switch (std::filesystem::status(path, ignored).type()) {
    case Kind::directory:
      return "a directory";
    case Kind::character:  // /dev/zero has no end
    case Kind::block:
      return "a device";
    case Kind::fifo:
      return has_name(path.c_str()) ? "a named pipe" : "";
    case Kind::socket:
      return "a socket";
    default:
      return "";
  }
}

std::string read_file(const std::string& path, std::uint64_t most) {
  const std::string_view kind = what_is_no_file(path);
  if (!kind.empty())
    cannot_read(path,
                "found " + std::string(kind) + ", expected a file" +
                    (kind == "a directory" ? "; name a file in it" : "; copy what is in it into a file"));
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) {
    const int reason = errno;
    if (reason == ENOENT) cannot_read(path, "no such file; check the path");
    cannot_read(path, std::string("cannot be opened (") + std::strerror(reason) + "); check its permissions");
  }
  std::error_code ignored;
  std::string bytes;
  // Reject large files before reading. Pipes have no size, so the limit is checked again after each chunk.
  const auto size = std::filesystem::file_size(path, ignored);
  if (!ignored && size > most) too_large(path, most);
  if (!ignored) bytes.reserve(size + 1);  // pipes have no size and grow as they come
  static constexpr std::size_t kChunk = std::size_t{1} << 18;
  for (;;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kChunk);
    const std::size_t got = std::fread(bytes.data() + before, 1, kChunk, file.get());
    bytes.resize(before + got);
    if (bytes.size() > most) too_large(path, most);
    // A short read is the end of the file or an error.
    if (got == kChunk) continue;
    if (std::ferror(file.get())) cannot_read(path, "reading failed; check the disk or copy the file again");
    return bytes;
  }
}

std::string in_quotes(std::string_view text, std::size_t limit) {
  const bool cut = text.size() > limit;
  return std::string(1, '\'').append(escaped(text.substr(0, limit), false)).append(cut ? "...'" : "'");
}

std::string printable_name(std::string_view name) {
  return escaped(name, true);
}

}  // namespace lrb
