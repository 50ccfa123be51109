#include "scenarios/io/zip.hpp"

#include <algorithm>
#include <limits>

#include <zlib.h>

#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::io {
namespace {

constexpr std::uint32_t kLocal = 0x04034b50, kCentral = 0x02014b50, kEnd = 0x06054b50;
constexpr std::size_t kLocalSize = 30, kCentralSize = 46, kEndSize = 22, kMaxComment = 65535;
constexpr std::uint64_t kStored = 0, kDeflated = 8, kVersion = 20, kFirstDay = 0x21;  // 1980-01-01

void put(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

std::uint64_t get(const std::string& in, std::size_t at, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i)
    value |= std::uint64_t{static_cast<unsigned char>(in[at + static_cast<std::size_t>(i)])} << (8 * i);
  return value;
}

std::uint64_t checksum(const std::string& bytes) {
  return crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

/// A deflate stream without zlib's header.
constexpr int kRaw = -MAX_WBITS;

std::string deflated(const std::string& bytes) {
  z_stream z{};
  if (deflateInit2(&z, Z_BEST_COMPRESSION, Z_DEFLATED, kRaw, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw EnvironmentError("zlib: out of memory");
  std::string out(deflateBound(&z, bytes.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib does not write to it
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

/// Expands a deflate stream. Returns false unless it has exactly `size` bytes.
bool inflate_into(const std::string& in, std::string& out, std::size_t size) {
  out.assign(size, '\0');
  z_stream z{};
  if (inflateInit2(&z, kRaw) != Z_OK) throw EnvironmentError("zlib: out of memory");
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
  z.avail_in = static_cast<uInt>(in.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  const int code = inflate(&z, Z_FINISH);
  const bool whole = code == Z_STREAM_END && z.total_out == size;
  inflateEnd(&z);
  return whole;
}

}  // namespace

std::string zip(const std::vector<ZipEntry>& entries) {
  std::string out, directory;
  for (const ZipEntry& e : entries) {
    if (e.bytes.size() > std::numeric_limits<std::uint32_t>::max() / 2 ||
        out.size() > std::numeric_limits<std::uint32_t>::max() / 2)
      throw InputError(printable_name(e.name) + ": is too large for an archive (2 GiB)");
    std::string data = deflated(e.bytes);
    const bool smaller = data.size() < e.bytes.size();
    if (!smaller) data = e.bytes;
    std::string head;  // common to both headers
    put(head, kVersion, 2);
    put(head, 0, 2);  // flags
    put(head, smaller ? kDeflated : kStored, 2);
    put(head, kFirstDay << 16, 4);
    put(head, checksum(e.bytes), 4);
    put(head, data.size(), 4);
    put(head, e.bytes.size(), 4);
    put(head, e.name.size(), 2);
    put(head, 0, 2);  // extra field
    put(directory, kCentral, 4);
    put(directory, kVersion, 2);
    directory += head;
    put(directory, 0, 10);  // comment, disk, attributes
    put(directory, out.size(), 4);
    directory += e.name;
    put(out, kLocal, 4);
    out += head + e.name + data;
  }
  const std::size_t start = out.size();
  out += directory;
  put(out, kEnd, 4);
  put(out, 0, 4);  // disks
  put(out, entries.size(), 2);
  put(out, entries.size(), 2);
  put(out, directory.size(), 4);
  put(out, start, 4);
  put(out, 0, 2);  // comment
  return out;
}

std::vector<ZipEntry> unzip(const std::string& archive, const std::string& file,
                            const std::function<bool(const std::string&)>& wanted, std::uint64_t most) {
  const auto damaged = [&](const std::string& what) -> InputError {
    return InputError(printable_name(file) + ": " + what + "; download or make the archive again");
  };
  // The end record is at the end, before a comment.
  std::size_t end = archive.size();
  for (std::size_t back = kEndSize; back <= std::min(archive.size(), kEndSize + kMaxComment); ++back)
    if (get(archive, archive.size() - back, 4) == kEnd) {
      end = archive.size() - back;
      break;
    }
  if (end == archive.size()) throw damaged("is not a ZIP archive, or is truncated");
  std::uint64_t at = get(archive, end + 16, 4), total = 0;
  std::vector<ZipEntry> out;
  for (std::uint64_t i = get(archive, end + 10, 2); i > 0; --i) {
    if (at + kCentralSize > end || get(archive, at, 4) != kCentral) throw damaged("has a damaged directory");
    const std::uint64_t method = get(archive, at + 10, 2), crc = get(archive, at + 16, 4),
                        packed = get(archive, at + 20, 4), size = get(archive, at + 24, 4),
                        name_size = get(archive, at + 28, 2), local = get(archive, at + 42, 4);
    if (at + kCentralSize + name_size > end) throw damaged("has a damaged directory");
    const std::string name = archive.substr(at + kCentralSize, name_size);
    at += kCentralSize + name_size + get(archive, at + 30, 2) + get(archive, at + 32, 2);
    if (!wanted(name)) continue;
    total += size;
    if (total > most) throw damaged("expands to more than " + std::to_string(most >> 20) + " MiB");
    if (local + kLocalSize > end || get(archive, local, 4) != kLocal)
      throw damaged("has a damaged entry " + printable_name(name));
    const std::uint64_t data = local + kLocalSize + get(archive, local + 26, 2) + get(archive, local + 28, 2);
    if (data + packed > end || (method == kStored && packed != size))
      throw damaged("has a truncated entry " + printable_name(name));
    ZipEntry entry{name, archive.substr(data, packed)};
    if (method == kDeflated) {
      std::string bytes;
      if (!inflate_into(entry.bytes, bytes, size))
        throw damaged("has a damaged entry " + printable_name(name));
      entry.bytes = std::move(bytes);
    } else if (method != kStored) {
      throw damaged("compresses " + printable_name(name) + " by an unknown method");
    }
    if (checksum(entry.bytes) != crc) throw damaged("has a damaged entry " + printable_name(name));
    out.push_back(std::move(entry));
  }
  return out;
}

}  // namespace lrb::io
