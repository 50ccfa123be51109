#pragma once
/// Reads and writes ZIP archives (APPNOTE 6.3.3: stored and deflated entries, without encryption and ZIP64).

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lrb::io {

struct ZipEntry {
  std::string name;  ///< with / between folders
  std::string bytes;
};

/// Returns an archive. It depends on nothing but the entries, and zlib: no times, no owners.
std::string zip(const std::vector<ZipEntry>& entries);

/// Returns the entries of an archive that `wanted` selects by name, in the order of its directory. `file`
/// names the archive in messages. Throws InputError for a damaged archive, and for more than `most` bytes in
/// all.
std::vector<ZipEntry> unzip(const std::string& archive, const std::string& file,
                            const std::function<bool(const std::string&)>& wanted,
                            std::uint64_t most = std::uint64_t{1} << 30);

}  // namespace lrb::io
