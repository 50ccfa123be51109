#pragma once
/// The rims of a surface that is open: its open edges, put together to loops.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

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

// Closes holes where that can be done without meeting anything, and proves it.

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

/// What join_corners() has done.
struct JoinedCorners {
  std::uint32_t before = 0, after = 0;            ///< vertices that faces use
  std::uint32_t open_before = 0, open_after = 0;  ///< open edges (2D: loose ends)
  bool any() const { return after < before; }
};

/// Joins vertices in exactly the same place (0 and -0 count as the same) where the surface is open: many
/// files give each face vertices of its own, so that every edge is open although nothing gapes. Faces keep
/// their numbers, and vertices theirs; those that no face uses any more are listed in Mesh::joined.
///
/// Only the ends of open edges (2D: loose ends) are joined, and only with those of open edges in the same
/// place. So a piece that is closed is never touched: two bodies that are kept apart though they touch in a
/// corner or along an edge stay as they are, and so do surfaces that are open elsewhere and pass through one
/// place. Edges that fit one to one, in opposite directions, are joined first, again and again: where two
/// boxes of loose faces touch along an edge, what their other edges tell keeps them two boxes. What is then
/// still open and lies in one place is joined as well; it becomes closed, or the fault that it is (an edge
/// with more than two faces, faces that contradict each other).
JoinedCorners join_corners(Mesh& mesh);

}  // namespace lrb
