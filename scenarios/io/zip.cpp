#include "scenarios/io/zip.hpp"

#include <cstdint>
#include <limits>

#include <zlib.h>

#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::io {
namespace {

constexpr std::uint32_t kLocal = 0x04034b50, kCentral = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint64_t kStored = 0, kDeflated = 8, kVersion = 20, kFirstDay = 0x21;  // 1980-01-01

void put(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
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

}  // namespace lrb::io
