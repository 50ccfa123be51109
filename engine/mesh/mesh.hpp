#pragma once
/// A polygon mesh as read from a file: flat arrays, nothing repaired.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/core/ids.hpp"

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

}  // namespace lrb
