#pragma once
/// The rims of a surface that is open: its open edges, put together to loops.

#include <vector>

#include <Eigen/Geometry>

#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb {

/// A row of open edges, each of which begins where the one before ends.
struct BoundaryLoop {
  /// In order, as the faces along the rim run; no vertex twice. The last joins the first, if it is a loop.
  std::vector<VertexId> vertices;
  /// It comes back to where it began. If not, it ends at edges with more than two faces, or at faces that
  /// disagree on which side is outside.
  bool is_loop = false;
  FaceId face = kNull;      ///< one of the faces along the rim
  bool planar = false;      ///< all vertices lie in one plane: exact
  double length = 0;        ///< sum over its edges; the mesh's unit
  Eigen::AlignedBox3d box;  ///< around its vertices
  std::size_t edges() const { return is_loop ? vertices.size() : vertices.size() - 1; }
};

/// Finds the loops of a mesh in space, the longest first. Every open edge is in one of them. A rim that comes
/// through a vertex twice, as that of two holes which touch there, becomes two loops. None for 2D bodies.
std::vector<BoundaryLoop> find_boundary_loops(const Mesh& mesh, const std::vector<FaceUse>& use);

}  // namespace lrb
