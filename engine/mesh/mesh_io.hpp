#pragma once
/// Mesh files in, and out again for other tools.

#include <string>

#include "engine/mesh/mesh.hpp"

namespace lrb {

/// Reads OBJ, STL (ASCII or binary), PLY (ASCII, binary of both endians) or OFF, told apart by content first and
/// extension second. Also 2D bodies: an OBJ whose elements are `l` polylines closed on themselves, z = 0 (dim 2).
/// Vertices of STL are merged where they are equal to the bit. Throws InputError: "file:line: what, expected, do".
Mesh read_mesh(const std::string& path);

/// The same from memory; `name` stands for the file in messages, its extension helps where content does not tell.
Mesh read_mesh(const std::string& bytes, const std::string& name);

/// As PLY (binary little-endian, uchar/int face lists, optional colours per face) or OBJ, by extension.
void write_mesh(const Mesh& mesh, const std::string& path);

}  // namespace lrb
