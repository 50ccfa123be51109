#pragma once
/// Bytes of .lrb files, of this version and of version 1.

#include <cstdint>
#include <cstring>
#include <string>

#include "tests/mesh/io/encode.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::test {

inline constexpr std::size_t kVersionAt = 8, kNameAt = 24;  ///< where these stand in the file

inline std::string lrb_bytes(const LrbRep& rep) {
  const Folder folder;
  save_lrb(rep, folder / "body.lrb");
  return load_bytes(folder / "body.lrb");
}

/// With the checksum of its content, in the version that it names.
inline std::string with_right_checksum(std::string file) {
  std::uint32_t version = 0;
  if (file.size() < kVersionAt + sizeof version + sizeof(std::uint64_t)) return file;
  std::memcpy(&version, file.data() + kVersionAt, sizeof version);
  const std::size_t end = file.size() - sizeof(std::uint64_t);
  const std::uint64_t sum = lrb_checksum(std::string_view(file).substr(0, end), version);
  std::memcpy(file.data() + end, &sum, sizeof sum);
  return file;
}

/// As version 1 was written.
inline std::string lrb_bytes_version_1(const LrbRep& rep) {
  std::string out = lrb_bytes(rep).substr(0, kNameAt);
  out[kVersionAt] = 1;
  const auto array = [&](const auto& x) {
    const auto count = static_cast<std::uint64_t>(x.size());
    out.append(reinterpret_cast<const char*>(&count), sizeof count);
    out.append(reinterpret_cast<const char*>(x.data()), x.size() * sizeof(x[0]));
  };
  const LrbData& d = rep.data();
  array(d.name);
  array(d.vertices);
  array(d.face_offsets);
  array(d.face_vertices);
  array(d.inner_cell);
  array(d.outer_cell);
  array(d.region_layer);
  return with_right_checksum(out + std::string(sizeof(std::uint64_t), '\0'));
}

}  // namespace lrb::test
