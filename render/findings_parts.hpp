#pragma once
/// What the offenders of a fault are made of: faces, edges and vertices. Private to findings*.cpp.

#include <array>
#include <string>
#include <vector>

#include <lrbscope/mesh_check.hpp>

namespace lrb::render::findings {

using Element = std::array<std::uint32_t, 2>;

/// The parts of one offender; those that it does not have are empty.
struct Parts {
  std::vector<FaceId> faces;       ///< the offending faces themselves
  std::vector<VertexId> vertices;  ///< the offending vertices
  bool edge = false;               ///< the two vertices are an edge
};
Parts parts_of(const Mesh& mesh, MeshFault kind, const Element& element);

/// Returns what an offender is called: "0-42", "3 + 80", "7".
std::string number_of(MeshFault kind, const Element& element);

std::vector<Eigen::Vector3d> corners(const Mesh& mesh, FaceId f);
Eigen::Vector3d normal(const Mesh& mesh, FaceId f);  ///< not of unit length; 0 in 2D
/// Returns the faces that are connected with this one by shared vertices.
std::vector<FaceId> component(const Mesh& mesh, FaceId first);
/// Returns the segment (2D: point) in which two faces cut each other, in doubles; empty if they do not, or
/// lie in one plane.
std::vector<Eigen::Vector3d> cut(const Mesh& mesh, FaceId f, FaceId g);

/// Returns true if a segment passes through a face, in doubles.
bool passes_through(const Mesh& mesh, FaceId f, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace lrb::render::findings
