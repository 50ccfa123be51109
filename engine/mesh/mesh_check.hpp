#pragma once
/// Checks a mesh and names its faults: nothing is repaired silently.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mesh/mesh.hpp"

namespace lrb {

/// Every fault that a mesh can have.
/// MESH_FAULT(enumerator, what it says, can still be built?, can still be queried?)
#define LRB_MESH_FAULTS(MESH_FAULT)                                                                  \
  MESH_FAULT(no_faces, "the mesh has no faces", false, false)                                        \
  MESH_FAULT(non_finite_vertex, "a coordinate is not finite", false, false)                          \
  MESH_FAULT(index_out_of_range, "a face names a vertex that does not exist", false, false)          \
  MESH_FAULT(repeated_corner, "a face names a vertex twice", false, true)                            \
  MESH_FAULT(zero_area_face, "a face has no area", false, true)                                      \
  MESH_FAULT(non_planar_face, "a polygon's corners do not lie in one plane", true, true)             \
  MESH_FAULT(non_convex_face, "a polygon is not convex", false, true)                                \
  MESH_FAULT(duplicate_face, "two faces have the same corners", false, true)                         \
  MESH_FAULT(open_edge, "an edge has a face on one side only", false, true)                          \
  MESH_FAULT(non_manifold_edge, "an edge has more than two faces", false, true)                      \
  MESH_FAULT(flipped_face, "two neighbouring faces disagree on which side is outside", false, true)  \
  MESH_FAULT(non_manifold_vertex, "a vertex joins two fans of faces", true, true)                    \
  MESH_FAULT(inside_out, "the body is inside out", false, true)                                      \
  MESH_FAULT(self_intersection, "two faces meet outside their shared edges and corners", true, true) \
  MESH_FAULT(duplicate_vertex, "two vertices lie in one place", true, true)                          \
  MESH_FAULT(unused_vertex, "no face uses a vertex", true, true)

enum class MeshFault : std::uint8_t {
#define MESH_FAULT(name, text, build, query) name,
  LRB_MESH_FAULTS(MESH_FAULT)
#undef MESH_FAULT
      count_
};
inline constexpr std::size_t kMeshFaultCount = static_cast<std::size_t>(MeshFault::count_);

/// Returns the enumerator's own name: "open_edge".
std::string_view name_of(MeshFault fault);

struct MeshFinding {
  static constexpr std::size_t kShown = 8;  ///< enough to find the place, few enough to read
  std::uint64_t count = 0;
  /// The first offenders, ascending, as many as MeshReport::kept: a vertex, face or component (by its first
  /// face) and kNull; two faces or vertices; a face and its vertex; an edge by its vertices (2D: the vertex
  /// and kNull).
  std::vector<std::array<std::uint32_t, 2>> first;
};

struct MeshReport {
  std::array<MeshFinding, kMeshFaultCount> findings;
  std::size_t kept = MeshFinding::kShown;  ///< the most offenders that are kept of each finding
  std::uint32_t components = 0;            ///< edge-connected pieces of the surface
  std::uint32_t open_components = 0;       ///< those with an open edge
  std::uint32_t sheets = 0;                ///< those of them that lie in one plane, and so bound nothing
  int genus = -1;                          ///< sum over the closed components; -1 if not closed and manifold
  bool closed = false;                     ///< every edge has exactly two faces, in opposite directions
  bool bounds_solid =
      /// Every edge is passed as often one way as the other: weaker than closed (bodies may share edges), and
      /// enough for "inside" to have a meaning, by parity.
      false;
  bool self_intersections_checked = false;

  const MeshFinding& operator[](MeshFault f) const { return findings[static_cast<std::size_t>(f)]; }
  bool buildable() const;  ///< no finding that forbids an LRB-rep: build_lrb() takes the mesh as it is
  bool queryable() const;
  /// Returns the report as it is once orient_outward() has turned what is inside out: that finding is gone,
  /// no other has changed.
  MeshReport when_turned() const;
  /// Returns the report with kShown offenders of each finding at most.
  MeshReport shortened() const;
  /// Returns one line for a fault that was found, with its first offenders.
  std::string line(MeshFault fault, const Mesh& mesh) const;
  /// Returns one line for each fault found, with its first offenders.
  std::vector<std::string> lines(const Mesh& mesh) const;
  /// Returns those lines that forbid an LRB-rep.
  std::vector<std::string> obstacles(const Mesh& mesh) const;
};

/// Checks everything (to go on with the mesh, see checked_mesh.hpp); self-intersections exactly and by a box
/// tree, only if asked (they take the longest). Faces without area count as zero_area_face only, and what
/// they touch is no self-intersection. In 2D vertices are judged as edges are in 3D: one segment must lead to
/// each and one away from it.
MeshReport check_mesh(const Mesh& mesh, bool self_intersections = true);

/// Turns every component that is inside out so that the solid lies behind its faces. A component directly
/// inside an odd number of others is a void and must face the other way; this is decided by parity.
/// Components that are not closed stay as they are. Returns the number of components turned. The triangles of
/// a turned triangle or quad keep their numbers; those of a larger polygon's fan are numbered the other way
/// round.
std::uint32_t orient_outward(Mesh& mesh);

/// Turns the faces of these components round, as orient_outward() does.
void turn_faces(Mesh& mesh, const std::vector<std::vector<FaceId>>& components);

}  // namespace lrb
