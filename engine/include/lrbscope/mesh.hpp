#pragma once
/// A polygon mesh as read from a file: flat arrays, without any repair.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/ids.hpp>

namespace lrb {

/// The boundary of a body. 3D: a face is a polygon with its corners counter-clockwise seen from outside, and
/// consists of the triangles of cut_polygon(). 2D: a face is a segment in the plane z = 0 with the solid on
/// its left.
struct Mesh {
  int dim = 3;                                    ///< 3, or 2 for closed polygons made of segments
  std::vector<Eigen::Vector3d> vertices;          ///< (|V| x 3), unit of the file; z = 0 in 2D
  std::vector<std::uint32_t> face_offsets = {0};  ///< (|F| + 1), into face_vertices
  std::vector<VertexId> face_vertices;            ///< corners of all faces, concatenated
  /// Vertices that join_corners() merged into others, ascending. Empty for most meshes.
  std::vector<VertexId> joined;
  std::string name;  ///< for messages: name of the file or of the generator

  std::size_t face_count() const { return face_offsets.size() - 1; }
  std::span<const VertexId> face(FaceId f) const {
    return {face_vertices.data() + face_offsets[f], face_offsets[f + 1] - face_offsets[f]};
  }
  void add_face(std::span<const VertexId> corners) {
    face_vertices.insert(face_vertices.end(), corners.begin(), corners.end());
    face_offsets.push_back(static_cast<std::uint32_t>(face_vertices.size()));
  }
  /// Returns the number of simplices of a face with `corners` corners: in 3D its triangles, in 2D 1 (the
  /// segment itself).
  static std::size_t simplices_of(std::size_t corners, int dim) { return dim == 2 ? 1 : corners - 2; }
};

/// How a polygon is divided into triangles.
enum class PolygonCut : std::uint8_t {
  fan,     ///< by the fan from its first corner, which covers it; so are all convex polygons
  ears,    ///< by other triangles, which cover it
  folded,  ///< by the fan, although that does not cover it: the outline crosses itself, or is far from planar
};

/// Divides a polygon of n > 2 corners (finite) into n - 2 triangles, as all queries do: triples of indices of
/// corners. Decides by exact tests in the projection along the axis closest to the polygon's normal. There
/// the triangles of `fan` and `ears` cover each point as often as the outline winds around it. The outline
/// may touch itself, and walk an edge in both directions, as at the bridge to a hole. `folded`: a corner is
/// further than a tenth of the polygon's size from its mean plane, or no such triangles exist.
PolygonCut cut_polygon(std::span<const Eigen::Vector3d> corners,
                       std::vector<std::array<std::uint32_t, 3>>& triangles);
/// Divides a face of a mesh, whose corners exist and are finite.
PolygonCut cut_polygon(const Mesh& mesh, FaceId f, std::vector<std::array<VertexId, 3>>& triangles);

// Reading and writing of mesh files.

/// Reads a mesh from an OBJ, STL (ASCII or binary), PLY (ASCII or binary, either endianness) or OFF file. The
/// format is detected by content first and by extension second. An OBJ file of closed `l` polylines with z =
/// 0 is a 2D body (dim 2). STL vertices with bitwise equal coordinates are merged. Throws InputError with
/// file, line, the expected and the found content, and a remedy.
Mesh read_mesh(const std::string& path);

/// Reads a mesh from memory. `name` replaces the path in messages; its extension is used where the content is
/// ambiguous.
Mesh read_mesh(const std::string& bytes, const std::string& name);

/// Returns true for the usual extension of a format that read_mesh() reads, in any case.
bool has_mesh_extension(std::string_view path);

using FaceColour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// Throws InputError if write_mesh() cannot write a mesh of this dimension to a file of this name.
void check_mesh_name(const std::string& path, int dim);

/// Writes a mesh as PLY (binary little-endian, uchar/int face lists, optional face colours) or OBJ, chosen by
/// extension. OBJ has no colours. 2D bodies are written as OBJ only. `face_colours`: empty, or one for each
/// face. The write is atomic (AtomicFile). Throws InputError for a wrong extension, a bad path or a wrong
/// number of colours, and EnvironmentError for failures of the machine such as a full disk.
void write_mesh(const Mesh& mesh, const std::string& path, std::span<const FaceColour> face_colours = {});

}  // namespace lrb
