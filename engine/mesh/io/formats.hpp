#pragma once
/// The readers of mesh files, and their common checks.

#include <cstdint>
#include <optional>
#include <string_view>

#include <lrbscope/mesh.hpp>

namespace lrb {

/// The keyword at the start of an OFF file: [ST][C][N][4][n]OFF.
struct OffHeader {
  bool has_extras = false;         ///< vertices have texture (ST), colour (C) or normal (N)
  bool dimensions_differ = false;  ///< 4 or n: vertices are not three-dimensional
};

/// Returns the header described by a keyword, or nullopt if it is not one.
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

/// Returns the length of the header of an OFF file at the beginning of its first word, or 0. Some files have
/// no blank between it and the first count: OFF8.
inline std::size_t off_header_size(std::string_view word) {
  const std::size_t digits = word.find_last_not_of("0123456789") + 1;
  return parse_off_header(word.substr(0, digits)) ? digits : 0;
}

// One reader for each format. They take the content of the file and its name for messages. They throw
// InputError with name and line (binary files: byte and element), the expected and the found content, and a
// remedy.
//
// A library is not used, because triangles must be numbered in file order (in answers, traces and
// fingerprints) and errors must be precise. Assimp, the established library for these formats, splits and
// joins faces by material, drops degenerate ones and reports errors without a line.

Mesh read_obj(std::string_view bytes, std::string_view name);
Mesh read_stl_ascii(std::string_view bytes, std::string_view name);
Mesh read_stl_binary(std::string_view bytes, std::string_view name);
Mesh read_ply(std::string_view bytes, std::string_view name);
Mesh read_off(std::string_view bytes, std::string_view name);

/// Returns true if the size fits a binary STL file: 84 bytes, plus 50 for each triangle in its header.
bool has_size_of_binary_stl(std::string_view bytes);

/// Throws InputError unless the counts fit the engine's 32-bit indices.
void check_index_limits(std::uint64_t vertices, std::uint64_t corners, std::string_view name);

/// Throws InputError if the mesh has no faces and therefore cannot be queried.
void reject_without_faces(const Mesh& mesh, std::string_view name);

}  // namespace lrb
