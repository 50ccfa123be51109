#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::render::findings {

using Element = std::array<std::uint32_t, 2>;

/// The parts of one affected element; empty if it has none of a kind.
struct Parts {
  std::vector<FaceId> faces;       ///< the affected faces
  std::vector<VertexId> vertices;  ///< the affected vertices
  bool edge = false;               ///< the two vertices form an edge
};

Parts parts_of(const Mesh& mesh, MeshFault kind, const Element& e);
/// Returns the display name of an affected element: "0-42", "3 + 80", "7".
std::string number_of(MeshFault kind, const Element& e);

std::vector<Eigen::Vector3d> corners(const Mesh& mesh, FaceId f);
/// Not of unit length; 0 in 2D.
Eigen::Vector3d normal(const Mesh& mesh, FaceId f);

}  // namespace lrb::render::findings
