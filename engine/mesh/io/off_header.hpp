#pragma once

#include <optional>
#include <string_view>

namespace lrb {

/// The keyword that opens an OFF file: [ST][C][N][4][n]OFF.
struct OffHeader {
  bool has_extras = false;         ///< vertices carry texture (ST), colour (C) or normal (N)
  bool dimensions_differ = false;  ///< 4 or n: not vertices in three dimensions
};

inline std::optional<OffHeader> parse_off_header(std::string_view word) {
  OffHeader header;
  const auto eat = [&](std::string_view prefix) {
    if (!word.starts_with(prefix)) return false;
    word.remove_prefix(prefix.size());
    return true;
  };
  for (const std::string_view extra : {"ST", "C", "N"}) header.has_extras |= eat(extra);
  for (const std::string_view dimension : {"4", "n"}) header.dimensions_differ |= eat(dimension);
  return word == "OFF" ? std::optional(header) : std::nullopt;
}

}  // namespace lrb
