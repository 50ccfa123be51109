#pragma once
/// Boundary loops of an open surface, hole filling, and merging of vertices that coincide or nearly do.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb {

/// A chain of open edges; each begins where the previous one ends.
struct BoundaryLoop {
  /// In the direction of the adjacent faces' edges; no vertex twice. If is_loop, the last connects to the
  /// first.
  std::vector<VertexId> vertices;
  /// The chain is closed. Otherwise it ends at edges with more than two faces, or at inconsistently oriented
  /// faces.
  bool is_loop = false;
  FaceId face = kNull;      ///< one of the faces along the loop
  bool planar = false;      ///< all vertices are coplanar: exact
  double length = 0;        ///< sum of its edge lengths; mesh units
  Eigen::AlignedBox3d box;  ///< AABB of its vertices
  std::size_t edges() const { return is_loop ? vertices.size() : vertices.size() - 1; }
};

/// Finds the boundary loops of a 3D mesh, longest first. Every open edge is in exactly one of them. A
/// boundary that passes through a vertex twice, as at two holes that touch there, is split into two loops.
/// Returns none for 2D bodies.
std::vector<BoundaryLoop> find_boundary_loops(const Mesh& mesh, const std::vector<FaceUse>& use);

// Hole filling, with a proof that the fill intersects nothing.

/// The result for one hole.
enum class HoleState : std::uint8_t {
  closed,          ///< filled on its own
  closed_as_ring,  ///< filled together with an enclosing or enclosed hole, by a ring between the two
  not_a_loop,      ///< its boundary is not a closed loop
  no_area,  ///< a slit: fills would have triangles whose corners are collinear within 1e-6 of their size
  meets_surface,  ///< every fill that was tried would intersect an existing face
  meets_lid,      ///< every fill that was tried would intersect the fill of another hole
  meets_itself,  ///< every fill that was tried would intersect itself, or duplicate an edge of existing faces
};

struct Hole {
  BoundaryLoop loop;
  HoleState state = HoleState::not_a_loop;
  bool of_sheet = false;  ///< boundary of a component that lies in one plane and therefore bounds no solid
  std::uint32_t first_face = kNull;  ///< first face of its fill, if closed
  std::uint32_t faces = 0;           ///< number of faces of its fill
  /// The existing face that a fill would intersect (meets_surface), or the other hole (meets_lid).
  std::uint32_t obstacle = kNull;
};

struct ClosedHoles {
  Mesh mesh;                ///< the given mesh, then new vertices and faces
  std::vector<Hole> holes;  ///< in the order of find_boundary_loops()
  std::uint32_t new_vertices = 0, new_faces = 0;
};

/// Fills the holes of a 3D mesh with triangles. Existing vertices and faces are unchanged and keep their
/// numbers.
///
/// Fills are tried in this order:
/// - Planar hole: its polygon, minus the planar holes in it whose loops have the opposite orientation (the
///   end of a thick-walled tube is a ring).
/// - Other holes: the triangulation of least area (Klincsek 1980; Barequet and Sharir 1995), then ear
///   clipping in the plane of the mean normal, then a fan around the centroid of the loop, which adds a
///   vertex.
/// A fill is accepted if exact tests prove that its triangles intersect existing faces, other fills and each
/// other only in shared corners and edges, and that no new edge connects two vertices that an edge connects
/// already. (Faces without area are not tested; they are reported separately.)
ClosedHoles close_holes(const CheckedMesh& mesh);

/// The effect of join_corners().
struct JoinedCorners {
  std::uint32_t before = 0, after = 0;            ///< number of vertices used by faces
  std::uint32_t open_before = 0, open_after = 0;  ///< number of open edges (2D: loose ends)
  bool any() const { return after < before; }
};

/// Merges vertices with equal coordinates (0 and -0 are equal) where the surface is open. Many files give
/// each face its own vertices, so that every edge is open although there is no gap. Faces and vertices keep
/// their numbers; vertices that no face uses any more are listed in Mesh::joined.
///
/// Only ends of open edges (2D: loose ends) are merged, and only with each other. A closed piece is therefore
/// never changed: two bodies that touch in a corner or along an edge stay separate, and so do surfaces that
/// pass through one point and are open elsewhere.
///
/// 1. Edges that match one to one, in opposite directions, are merged first, repeatedly. Where two boxes of
///    loose faces touch along an edge, their other edges thus keep them separate.
/// 2. Remaining coincident open ends are merged. The result is closed, or a fault that the checks report (an
///    edge with more than two faces, inconsistently oriented faces).
JoinedCorners join_corners(Mesh& mesh);

/// The effect of weld_corners().
struct WeldedCorners {
  std::uint32_t welded = 0;  ///< number of vertices that moved to another one
  double farthest = 0;       ///< the largest distance that one of them moved
};

/// Closes the slits between nearly coincident vertices of open edges of a 3D mesh: moves each such vertex to
/// one with a smaller number within `distance` (the mesh's unit) that no open edge joins to it, and merges
/// the two as join_corners() does. All other vertices keep their coordinates, and faces keep their numbers.
///
/// Throws InputError if the distance is not above 0 or exceeds the size of all open edges, or if the result
/// has a fault where the mesh had none: faces without area, with a repeated corner, equal or folded faces,
/// edges with more than two faces, inconsistent orientation, or a face that intersects others and did not
/// before (exact). A component that the weld closes may face inwards: see CheckedMesh::turn_outward().
CheckedMesh weld_corners(const CheckedMesh& mesh, double distance, WeldedCorners& done);

}  // namespace lrb
