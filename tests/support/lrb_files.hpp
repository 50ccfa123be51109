#pragma once
/// Bytes of .lrb files, of this version and of version 1.

#include <cstdint>
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
  const std::uint64_t sum = lrb_checksum(out, 1);
  return out.append(reinterpret_cast<const char*>(&sum), sizeof sum);
}

}  // namespace lrb::test
