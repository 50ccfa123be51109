#pragma once
/// A polygon mesh as read from a file: flat arrays, nothing repaired.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/ids.hpp>

namespace lrb {

/// A body's boundary. In 3D a face is a convex planar polygon whose corners run counter-clockwise seen from
/// outside; in 2D it is a segment in the plane z = 0 with the solid on the left of its direction.
struct Mesh {
  int dim = 3;                                    ///< 3, or 2 for a closed polygon made of segments
  std::vector<Eigen::Vector3d> vertices;          ///< (|V| x 3), unit of the file; z = 0 in 2D
  std::vector<std::uint32_t> face_offsets = {0};  ///< (|F| + 1), into face_vertices
  std::vector<VertexId> face_vertices;            ///< corners of all faces, one after the other
  std::vector<VertexId>
      joined;        ///< ascending: those whose corners join_corners() gave to others; mostly none
  std::string name;  ///< for messages: the file's name, or the generator's

  std::size_t face_count() const { return face_offsets.size() - 1; }
  std::span<const VertexId> face(FaceId f) const {
    return {face_vertices.data() + face_offsets[f], face_offsets[f + 1] - face_offsets[f]};
  }
  void add_face(std::span<const VertexId> corners) {
    face_vertices.insert(face_vertices.end(), corners.begin(), corners.end());
    face_offsets.push_back(static_cast<std::uint32_t>(face_vertices.size()));
  }
  /// Returns the number of simplices of a face with `corners` corners: the triangles of its fan from the
  /// first corner; in 2D 1, the segment itself.
  static std::size_t simplices_of(std::size_t corners, int dim) { return dim == 2 ? 1 : corners - 2; }
};

// Reads mesh files, and writes them for other tools.

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
