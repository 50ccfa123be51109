#pragma once
/// Tells which format a file is in: its content decides, its extension helps only where the content leaves it
/// open.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <lrbscope/mesh.hpp>

namespace lrb {

enum class MeshFormat : std::uint8_t { obj, stl_ascii, stl_binary, ply, off };

/// Returns the format. Throws InputError, saying what the content looks like, if it is none of the formats.
MeshFormat tell_format(std::string_view bytes, std::string_view name);

/// Returns the extension in lower case, without the dot; empty if there is none.
std::string extension_of(std::string_view path);

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

// The readers, one for each format. They take the whole file and the name that stands for it in messages,
// and throw InputError "name:line: found ..., expected ...; what to do" (binary: byte and element).
//
// Why our own readers and not a library: triangles are numbered in file order throughout (in answers, traces
// and fingerprints), and a bad file must be refused with the line, what was expected and what to do. Assimp,
// the well-kept library for these formats, splits and joins faces by material, drops degenerate ones and
// reports errors without a line.

Mesh read_obj(std::string_view bytes, std::string_view name);
Mesh read_stl_ascii(std::string_view bytes, std::string_view name);
Mesh read_stl_binary(std::string_view bytes, std::string_view name);
Mesh read_ply(std::string_view bytes, std::string_view name);
Mesh read_off(std::string_view bytes, std::string_view name);

/// Returns true if the size is that of a binary STL file (84 bytes and 50 for each triangle that it claims).
bool has_size_of_binary_stl(std::string_view bytes);

/// Throws InputError unless the counts fit the engine's 32-bit indices.
void check_index_limits(std::uint64_t vertices, std::uint64_t corners, std::string_view name);

/// Throws InputError if the mesh has no faces, so that nothing of it can be queried.
void refuse_without_faces(const Mesh& mesh, std::string_view name);

}  // namespace lrb
