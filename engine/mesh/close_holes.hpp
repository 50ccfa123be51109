#pragma once
/// Closes holes where that can be done without meeting anything, and proves it.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/mesh/boundary_loops.hpp"
#include "engine/mesh/checked_mesh.hpp"

namespace lrb {

/// What has become of a hole.
enum class HoleState : std::uint8_t {
  closed,          ///< by a lid of its own
  closed_as_ring,  ///< together with the hole that it lies in, by a lid between the two
  not_a_loop,      ///< its rim is interrupted
  no_area,         ///< all of its rim lies on one line
  meets_surface,   ///< each lid that was tried would meet a face that was there
  meets_lid,       ///< ... or the lid of another hole
  meets_itself,    ///< ... or itself, or have an edge that faces have already
};

struct Hole {
  BoundaryLoop loop;
  HoleState state = HoleState::not_a_loop;
  bool of_sheet = false;             ///< the rim of a component that lies in one plane, and so bounds nothing
  std::uint32_t first_face = kNull;  ///< of its lid, if it is closed
  std::uint32_t faces = 0;           ///< of its lid
  std::uint32_t obstacle =
      kNull;  ///< the face that a lid would meet (meets_surface), or the hole (meets_lid)
};

struct ClosedHoles {
  Mesh mesh;                ///< what was there, then new vertices and faces
  std::vector<Hole> holes;  ///< as find_boundary_loops() orders them
  std::uint32_t new_vertices = 0, new_faces = 0;
};

/// Puts lids of triangles on the holes of a mesh in space. Vertices and faces that were there stay as they
/// are and keep their numbers.
///
/// Lids that are tried, in turn: for a flat hole its polygon, without those of the flat holes in it whose
/// rims run the other way round (the end of a tube with a thick wall is a ring); for others the triangulation
/// with the least area, then one made by cutting off corners in the plane of the mean normal, then a fan
/// about the middle of the rim, which adds a vertex. A lid stands if the exact tests prove that its triangles
/// meet neither a face that was there nor another lid nor each other in more than corners and edges that they
/// share, and no new edge joins two vertices that an edge joins already. (Faces without area are not tested;
/// they are findings of their own.)
ClosedHoles close_holes(const CheckedMesh& mesh);

}  // namespace lrb
