#pragma once
/// Finds which faces are neighbours, and what follows for the surface: components, closedness, genus.

#include <cstdint>
#include <vector>

#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/mesh.hpp"
#include "engine/mesh/mesh_check.hpp"

namespace lrb {

struct SurfaceTopology {
  std::uint32_t components = 0;
  std::vector<std::uint32_t> component_of_face;  ///< (|F|) numbered by first face; kNull: face cannot be used
  std::vector<bool> component_closed;            ///< every edge has exactly two faces, in opposite directions
  std::vector<bool> component_open;              ///< some edge has a face on one side only
  bool closed = false;                           ///< all faces can be used and all components are closed
  int genus = -1;  ///< sum over the components; -1 unless closed and every vertex has one fan. 2D: 0
};

/// Analyses the surface. In 3D neighbours share an edge; in 2D a vertex, with one segment leading in and one
/// out. Notes open and non-manifold edges, flipped faces and non-manifold vertices (2D: vertices in the place
/// of edges). Leaves out faces with fewer than three (2D: two) different corners, whose edges cancel each
/// other.
SurfaceTopology analyse_topology(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report);

}  // namespace lrb
