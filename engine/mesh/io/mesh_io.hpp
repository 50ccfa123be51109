#pragma once
/// Reads mesh files, and writes them for other tools.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/mesh/mesh.hpp"

namespace lrb {

/// Reads OBJ, STL (ASCII or binary), PLY (ASCII, binary of both endians) or OFF, told apart by content first
/// and extension second. Also reads 2D bodies: an OBJ whose elements are closed `l` polylines, z = 0 (dim 2).
/// Merges STL vertices that are equal to the bit. Throws InputError: "file:line: found what, expected what;
/// what to do".
Mesh read_mesh(const std::string& path);

/// Does the same from memory; `name` stands for the file in messages, and its extension helps where content
/// does not tell.
Mesh read_mesh(const std::string& bytes, const std::string& name);

using FaceColour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// Throws InputError unless write_mesh() writes a mesh of this dimension to a file of this name.
void check_mesh_name(const std::string& path, int dim);

/// Writes PLY (binary little-endian, uchar/int face lists, optional colours per face) or OBJ, by extension;
/// OBJ has no place for colours, and 2D bodies are written as OBJ only. The file appears whole or not at all.
/// Throws InputError (wrong extension, bad path, a number of colours other than that of the faces or none) or
/// EnvironmentError (disk full and the like).
void write_mesh(const Mesh& mesh, const std::string& path, std::span<const FaceColour> face_colours = {});

}  // namespace lrb
