#pragma once
/// Writes ZIP archives (APPNOTE 6.3.3: stored and deflated entries, without encryption and ZIP64).

#include <string>
#include <vector>

namespace lrb::io {

struct ZipEntry {
  std::string name;  ///< with / between folders
  std::string bytes;
};

/// Returns an archive. It depends on nothing but the entries, and zlib: no times, no owners.
std::string zip(const std::vector<ZipEntry>& entries);

}  // namespace lrb::io
