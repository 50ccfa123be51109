#pragma once
/// The readers, one for each format. They take the whole file and the name that stands for it in messages,
/// and throw InputError "name:line: found ..., expected ...; what to do" (binary: byte and element).
///
/// Why our own readers and not a library: triangles are numbered in file order throughout (in answers, traces
/// and fingerprints), and a bad file must be refused with the line, what was expected and what to do. Assimp,
/// the well-kept library for these formats, splits and joins faces by material, drops degenerate ones and
/// reports errors without a line.

#include <string_view>

#include "engine/mesh/mesh.hpp"

namespace lrb {

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
