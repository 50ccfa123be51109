#pragma once
/// The faces, edges and vertices affected by a fault. Private to findings*.cpp.

#include <array>
#include <string>
#include <vector>

#include <lrbscope/mesh_check.hpp>

namespace lrb::render::findings {

using Element = std::array<std::uint32_t, 2>;

/// The parts of one affected element; empty if it has none of a kind.
struct Parts {
  std::vector<FaceId> faces;       ///< the affected faces
  std::vector<VertexId> vertices;  ///< the affected vertices
  bool edge = false;               ///< the two vertices form an edge
};
Parts parts_of(const Mesh& mesh, MeshFault kind, const Element& element);

/// Returns the display name of an affected element: "0-42", "3 + 80", "7".
std::string number_of(MeshFault kind, const Element& element);

std::vector<Eigen::Vector3d> corners(const Mesh& mesh, FaceId f);
Eigen::Vector3d normal(const Mesh& mesh, FaceId f);  ///< not of unit length; 0 in 2D
/// Returns the faces connected to this one by shared vertices.
std::vector<FaceId> component(const Mesh& mesh, FaceId first);
/// Returns the segment (2D: point) in which two faces intersect, in doubles; empty if they are disjoint or
/// coplanar.
std::vector<Eigen::Vector3d> cut(const Mesh& mesh, FaceId f, FaceId g);

/// Returns true if a segment passes through a face, in doubles.
bool passes_through(const Mesh& mesh, FaceId f, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace lrb::render::findings
