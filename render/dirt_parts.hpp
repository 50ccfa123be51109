#pragma once
/// Offenders as faces, edges and vertices. Private to dirt*.cpp.

#include <array>
#include <string>
#include <vector>

#include "engine/mesh/mesh_check.hpp"

namespace lrb::render::dirt {

using Element = std::array<std::uint32_t, 2>;

/// What an offender is made of; the rest is empty.
struct Parts {
  std::vector<FaceId> faces;       ///< the offending faces themselves
  std::vector<VertexId> vertices;  ///< the offending vertices
  bool edge = false;               ///< the two vertices are an edge
};
Parts parts_of(const Mesh& mesh, MeshFault kind, const Element& element);

/// "0-42", "3 + 80", "7".
std::string number_of(MeshFault kind, const Element& element);

std::vector<Eigen::Vector3d> corners(const Mesh& mesh, FaceId f);
Eigen::Vector3d normal(const Mesh& mesh, FaceId f);  ///< not of unit length; 0 in 2D
/// Faces that hang together with this one over shared vertices.
std::vector<FaceId> component(const Mesh& mesh, FaceId first);
/// The segment (2D: point) in which two faces cut each other, in doubles; empty if they do not, or lie in one
/// plane.
std::vector<Eigen::Vector3d> cut(const Mesh& mesh, FaceId f, FaceId g);

/// Whether a segment passes through a face, in doubles.
bool passes_through(const Mesh& mesh, FaceId f, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace lrb::render::dirt
