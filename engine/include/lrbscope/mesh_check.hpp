#pragma once
/// Mesh checks that report faults without repairing anything.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <lrbscope/mesh.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

/// All faults that a mesh can have.
/// MESH_FAULT(enumerator, message, can an LRB-rep be built?, can the mesh be queried?)
#define LRB_MESH_FAULTS(MESH_FAULT)                                                                       \
  MESH_FAULT(no_faces, "the mesh has no faces", false, false)                                             \
  MESH_FAULT(non_finite_vertex, "a coordinate is not finite", false, false)                               \
  MESH_FAULT(index_out_of_range, "a face has a vertex index out of range", false, false)                  \
  MESH_FAULT(repeated_corner, "a face uses a vertex twice", false, true)                                  \
  MESH_FAULT(zero_area_face, "a face has no area", false, true)                                           \
  MESH_FAULT(sliver, "a triangle is a sliver", true, true)                                                \
  MESH_FAULT(non_planar_face, "a polygon is not planar", true, true)                                      \
  MESH_FAULT(non_convex_face, "a polygon is not convex", true, true)                                      \
  MESH_FAULT(folded_face, "a polygon crosses itself or is far from planar", true, true)                   \
  MESH_FAULT(duplicate_face, "two faces have the same corners", false, true)                              \
  MESH_FAULT(open_edge, "an edge has only one face", false, true)                                         \
  MESH_FAULT(t_junction, "a vertex lies on an open edge of a face (T-junction)", false, true)             \
  MESH_FAULT(near_vertex, "two vertices of open edges nearly coincide", false, true)                      \
  MESH_FAULT(non_manifold_edge, "an edge has more than two faces", false, true)                           \
  MESH_FAULT(flipped_face, "two adjacent faces are inconsistently oriented", false, true)                 \
  MESH_FAULT(reversed_face, "a face is reversed against the rest of its surface", false, true)            \
  MESH_FAULT(non_manifold_vertex, "a vertex joins two separate fans of faces", true, true)                \
  MESH_FAULT(inside_out, "a component is inside out", false, true)                                        \
  MESH_FAULT(self_intersection, "two faces intersect outside their shared edges and corners", true, true) \
  MESH_FAULT(duplicate_vertex, "two vertices coincide", true, true)                                       \
  MESH_FAULT(unused_vertex, "a vertex is not used by any face", true, true)

enum class MeshFault : std::uint8_t {
#define MESH_FAULT(name, text, build, query) name,
  LRB_MESH_FAULTS(MESH_FAULT)
#undef MESH_FAULT
      count_
};
inline constexpr std::size_t kMeshFaultCount = static_cast<std::size_t>(MeshFault::count_);

/// Returns the enumerator's identifier: "open_edge".
std::string_view name_of(MeshFault fault);

struct MeshFinding {
  static constexpr std::size_t kShown = 8;  ///< number of affected elements printed by default
  std::uint64_t count = 0;
  /// The first affected elements, ascending, at most MeshReport::kept. Each is one of: a vertex, face or
  /// component (by its first face) and kNull; two faces or vertices; a face and its vertex; a vertex and the
  /// face that it touches; an edge by its vertices (2D: a vertex and kNull).
  std::vector<std::array<std::uint32_t, 2>> first;
};

struct MeshReport {
  std::array<MeshFinding, kMeshFaultCount> findings;
  std::size_t kept = MeshFinding::kShown;  ///< maximum number of affected elements kept for each finding
  std::uint32_t components = 0;            ///< edge-connected components of the surface
  std::uint32_t open_components = 0;       ///< components with an open edge
  std::uint32_t sheets = 0;  ///< open components that lie in one plane and therefore bound no solid
  int genus = -1;            ///< sum over the closed components; -1 if not closed and manifold
  bool closed = false;       ///< every edge has exactly two faces, in opposite directions
  /// Every edge is traversed equally often in both directions. Weaker than closed (bodies may share edges),
  /// and sufficient for "inside" to be defined by parity.
  bool bounds_solid = false;
  bool self_intersections_checked = false;

  const MeshFinding& operator[](MeshFault f) const { return findings[static_cast<std::size_t>(f)]; }
  bool buildable() const;  ///< no finding forbids an LRB-rep: build_lrb() accepts the mesh as it is
  /// Returns true if no finding forbids queries.
  bool queryable() const;
  /// Returns the report for the mesh after orient_outward(): the finding inside_out is removed, all others
  /// are unchanged.
  MeshReport when_turned() const;
  /// Returns the report with at most kShown affected elements for each finding.
  MeshReport shortened() const;
  /// Returns one line for a fault that was found, with the first affected elements.
  std::string line(MeshFault fault, const Mesh& mesh) const;
  /// Returns one line for each fault found, with the first affected elements.
  std::vector<std::string> lines(const Mesh& mesh) const;
  /// Returns those of these lines that forbid an LRB-rep.
  std::vector<std::string> obstacles(const Mesh& mesh) const;
};

/// Runs all checks. (To continue with the mesh, use CheckedMesh.) Self-intersections are found exactly with a
/// box tree, and slivers (triangles with a height below 1e-4 of their longest edge), only if requested,
/// because they take longest. Faces without area are reported as zero_area_face only; contacts with them are
/// not self-intersections. In 2D, vertices take the role of edges: each must end one segment and start one.
MeshReport check_mesh(const Mesh& mesh, bool self_intersections = true);

/// Orients every closed component so that the solid is behind its faces. A component nested directly inside
/// an odd number of others is a void and is oriented the other way (decided by parity). Components that are
/// not closed are unchanged. Returns the number of components reversed. The triangles of a reversed triangle
/// or convex quad keep their numbers; those of a larger polygon are renumbered.
std::uint32_t orient_outward(Mesh& mesh);

/// Reverses the faces of these components, as orient_outward() does.
void turn_faces(Mesh& mesh, const std::vector<std::vector<FaceId>>& components);

// Checks of single faces, and search for faces with equal corners. Exact.

/// The checks and queries that a face is usable for; each value includes those before it.
enum class FaceUse : std::uint8_t {
  nothing,   ///< a vertex index is out of range
  topology,  ///< its corners exist, but one is not finite
  points,    ///< its corners are finite, but it has no area (2D: no length) or too few distinct corners
  area,      ///< has area; need not be planar or convex (its triangles: cut_polygon())
  convex,    ///< planar and convex (always so for triangles and segments)
};

/// Reports non-finite vertices, indices out of range, repeated corners, faces without area, and non-planar
/// and non-convex polygons. Returns the use of each face (|F|).
std::vector<FaceUse> check_faces(const Mesh& mesh, MeshReport& report);

/// Reports faces with the same set of corners as an earlier face.
void check_duplicates(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report);

/// Reports unused vertices, and vertices with the coordinates of an earlier one.
void check_vertices(const Mesh& mesh, MeshReport& report);

/// Counts a finding. Records the element(s) if they are among the first MeshReport::kept.
void note(MeshReport& report, MeshFault fault, std::uint32_t first, std::uint32_t second = kNull);

/// Sorts the recorded elements. Must be called after the last note().
void sort_elements(MeshReport& report);

// Adjacency of faces, and the properties derived from it: components, closedness, genus.

/// An open edge, in the direction of its face.
struct OpenEdge {
  VertexId from, to;
  FaceId face;
};

struct SurfaceTopology {
  std::uint32_t components = 0;
  std::vector<std::uint32_t> component_of_face;  ///< (|F|) numbered by first face; kNull: face is not usable
  std::vector<bool> component_closed;            ///< every edge has exactly two faces, in opposite directions
  std::vector<bool> component_open;              ///< some edge has a face on one side only
  std::vector<OpenEdge> open_edges;              ///< 3D: by face, then corner
  bool closed = false;                           ///< all faces are usable and all components are closed
  /// Every edge is traversed equally often in both directions: the boundary of the sum of the faces is empty.
  bool cycle = false;
  int genus = -1;  ///< sum over the components; -1 unless closed and every vertex has one fan. 2D: 0
};

/// Analyses the surface. Adjacent faces share an edge (3D), or a vertex at which one segment ends and the
/// other starts (2D). Reports open and non-manifold edges, flipped faces and non-manifold vertices (2D:
/// vertices in the role of edges); and if a surface can be oriented by reversing less than half of its faces,
/// these. Skips faces with fewer than three (2D: two) distinct corners, whose edges
/// cancel each other.
SurfaceTopology analyse_topology(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report);

/// Reports the likely causes of these open edges: vertices on the open edge of another face, and vertices
/// that nearly coincide, within 1e-6 of the diagonal of the open edges' box. At most one of each for a
/// vertex. 3D only.
void check_seams(const Mesh& mesh, const std::vector<FaceUse>& use, std::vector<OpenEdge> edges,
                 MeshReport& report);

// A mesh with the results of its checks, so that no check runs twice.

/// All results of checking a mesh once.
struct MeshFindings {
  MeshReport report;
  std::vector<FaceUse> use;  ///< (|F|)
  SurfaceTopology topology;
  std::vector<std::vector<FaceId>> inside_out;  ///< faces of each inward-oriented component
  std::vector<bool> sheet;  ///< (components) true for those that MeshReport::sheets counts
};

/// A mesh that has been checked. Only check() creates one and only turn_outward() changes its mesh, so
/// functions that take a CheckedMesh can rely on its report.
class CheckedMesh {
 public:
  const Mesh& mesh() const { return mesh_; }
  const MeshReport& report() const { return found_.report; }
  const std::vector<FaceUse>& use() const { return found_.use; }
  const SurfaceTopology& topology() const { return found_.topology; }
  /// Returns true if the face belongs to an open component that lies in one plane.
  bool is_of_sheet(FaceId f) const {
    const std::uint32_t component = found_.topology.component_of_face[f];
    return component != kNull && found_.sheet[component];
  }

  /// Reorients inward-oriented components (see orient_outward()), removes that finding from the report, and
  /// returns their number.
  std::uint32_t turn_outward();

  /// Finds pairs of faces that intersect beyond their shared corners and edges, and slivers, and adds them to
  /// the report.
  /// Takes longer than all other checks together. Has no effect if called before.
  void find_self_intersections();
  /// Returns the faces in such pairs, ascending. If find_self_intersections() was not called, searches for
  /// the faces without counting pairs, which is faster.
  std::vector<FaceId> self_intersecting_faces(Workers& workers) const;

 private:
  friend CheckedMesh check(Mesh mesh, std::size_t kept);
  CheckedMesh(Mesh mesh, std::size_t kept);

  Mesh mesh_;
  MeshFindings found_;
  std::optional<std::vector<FaceId>> meeting_;  ///< set after the search
};

/// Runs all checks except self-intersections. Records at most `kept` affected elements for each finding.
CheckedMesh check(Mesh mesh, std::size_t kept = MeshFinding::kShown);

/// Runs the same checks without taking ownership. The findings are valid until the mesh changes.
MeshFindings examine(const Mesh& mesh, std::size_t kept = MeshFinding::kShown);

}  // namespace lrb
