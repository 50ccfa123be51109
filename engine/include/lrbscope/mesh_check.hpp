#pragma once
/// Checks a mesh and names its faults: nothing is repaired silently.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <lrbscope/mesh.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

/// Every fault that a mesh can have.
/// MESH_FAULT(enumerator, what it says, can still be built?, can still be queried?)
#define LRB_MESH_FAULTS(MESH_FAULT)                                                                       \
  MESH_FAULT(no_faces, "the mesh has no faces", false, false)                                             \
  MESH_FAULT(non_finite_vertex, "a coordinate is not finite", false, false)                               \
  MESH_FAULT(index_out_of_range, "a face has a vertex index out of range", false, false)                  \
  MESH_FAULT(repeated_corner, "a face uses a vertex twice", false, true)                                  \
  MESH_FAULT(zero_area_face, "a face has no area", false, true)                                           \
  MESH_FAULT(non_planar_face, "a polygon is not planar", true, true)                                      \
  MESH_FAULT(non_convex_face, "a polygon is not convex", false, true)                                     \
  MESH_FAULT(duplicate_face, "two faces have the same corners", false, true)                              \
  MESH_FAULT(open_edge, "an edge has only one face", false, true)                                         \
  MESH_FAULT(non_manifold_edge, "an edge has more than two faces", false, true)                           \
  MESH_FAULT(flipped_face, "two adjacent faces are inconsistently oriented", false, true)                 \
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

/// Returns the enumerator's own name: "open_edge".
std::string_view name_of(MeshFault fault);

struct MeshFinding {
  static constexpr std::size_t kShown = 8;  ///< enough to find the place, few enough to read
  std::uint64_t count = 0;
  /// The first offenders, ascending, as many as MeshReport::kept: a vertex, face or component (by its
  /// first face) and kNull; two faces or vertices; a face and its vertex; an edge by its vertices (2D:
  /// the vertex and kNull).
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
      /// Every edge is passed as often one way as the other: weaker than closed (bodies may share
      /// edges), and enough for "inside" to have a meaning, by parity.
      false;
  bool self_intersections_checked = false;

  const MeshFinding& operator[](MeshFault f) const { return findings[static_cast<std::size_t>(f)]; }
  bool buildable() const;  ///< no finding that forbids an LRB-rep: build_lrb() takes the mesh as it is
  bool queryable() const;
  /// Returns the report as it is once orient_outward() has turned what is inside out: that finding is
  /// gone, no other has changed.
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

/// Checks everything (to go on with the mesh, see CheckedMesh); self-intersections exactly and by a box
/// tree, only if asked (they take the longest). Faces without area count as zero_area_face only, and
/// what they touch is no self-intersection. In 2D vertices are judged as edges are in 3D: one segment
/// must lead to each and one away from it.
MeshReport check_mesh(const Mesh& mesh, bool self_intersections = true);

/// Turns every component that is inside out so that the solid lies behind its faces. A component
/// directly inside an odd number of others is a void and must face the other way; this is decided by
/// parity. Components that are not closed stay as they are. Returns the number of components turned.
/// The triangles of a turned triangle or quad keep their numbers; those of a larger polygon's fan are
/// numbered the other way round.
std::uint32_t orient_outward(Mesh& mesh);

/// Turns the faces of these components round, as orient_outward() does.
void turn_faces(Mesh& mesh, const std::vector<std::vector<FaceId>>& components);

// Checks a mesh's faces one by one, and finds faces with the same corners. Exact.

/// What a face can be used for; each use includes those before it.
enum class FaceUse : std::uint8_t {
  nothing,   ///< it names a vertex that does not exist
  topology,  ///< its corners exist, but one is not finite
  points,    ///< its corners are finite, but it has no area (2D: no length), or too few different corners
  area,      ///< it is a proper face, perhaps neither planar nor convex
  convex,    ///< planar and convex (always so for triangles and segments)
};

/// Notes non-finite vertices, bad indices, repeated corners, faces without area, planarity and
/// convexity in the report. Returns what each face can be used for.
std::vector<FaceUse> check_faces(const Mesh& mesh, MeshReport& report);

/// Notes faces that have the same set of corners as an earlier one.
void check_duplicates(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report);

/// Notes vertices that no face names, and those with the coordinates of an earlier one.
void check_vertices(const Mesh& mesh, MeshReport& report);

/// Counts a finding, and keeps the element(s) if it is among the first, of which MeshReport::kept are
/// kept.
void note(MeshReport& report, MeshFault fault, std::uint32_t first, std::uint32_t second = kNull);

/// Puts what was kept in order. Call it after the last note().
void sort_offenders(MeshReport& report);

// Finds which faces are neighbours, and what follows for the surface: components, closedness, genus.

struct SurfaceTopology {
  std::uint32_t components = 0;
  std::vector<std::uint32_t> component_of_face;  ///< (|F|) numbered by first face; kNull: face cannot be used
  std::vector<bool> component_closed;            ///< every edge has exactly two faces, in opposite directions
  std::vector<bool> component_open;              ///< some edge has a face on one side only
  bool closed = false;                           ///< all faces can be used and all components are closed
  int genus = -1;  ///< sum over the components; -1 unless closed and every vertex has one fan. 2D: 0
};

/// Analyses the surface. In 3D neighbours share an edge; in 2D a vertex, with one segment leading in
/// and one out. Notes open and non-manifold edges, flipped faces and non-manifold vertices (2D:
/// vertices in the place of edges). Leaves out faces with fewer than three (2D: two) different corners,
/// whose edges cancel each other.
SurfaceTopology analyse_topology(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report);

// A mesh together with the findings of its checks, so that no check runs twice.

/// Everything that checking a mesh once finds out.
struct MeshFindings {
  MeshReport report;
  std::vector<FaceUse> use;  ///< (|F|)
  SurfaceTopology topology;
  std::vector<std::vector<FaceId>> inside_out;  ///< the faces of each component that faces the wrong way
  std::vector<bool> sheet;                      ///< (components) MeshReport::sheets counts them
};

/// A mesh that has been checked. Only check() makes one, and only turn_outward() changes its mesh, so
/// that a function that takes one can rely on its report and need not check the mesh again.
class CheckedMesh {
 public:
  const Mesh& mesh() const { return mesh_; }
  const MeshReport& report() const { return found_.report; }
  const std::vector<FaceUse>& use() const { return found_.use; }
  const SurfaceTopology& topology() const { return found_.topology; }
  /// Returns true if a face belongs to a component with an open edge that lies in one plane.
  bool is_of_sheet(FaceId f) const {
    const std::uint32_t component = found_.topology.component_of_face[f];
    return component != kNull && found_.sheet[component];
  }

  /// Turns the components that are inside out (see orient_outward()) and returns their number. The
  /// report no longer names them.
  std::uint32_t turn_outward();

  /// Looks for pairs of faces that meet in more than they share, which takes longer than all other
  /// checks, and adds them to the report. Does nothing if that has been done.
  void find_self_intersections();
  /// Returns the faces in such pairs, ascending: those that find_self_intersections() found. If it was
  /// not called, finds them now, which is faster because pairs are not counted.
  std::vector<FaceId> self_intersecting_faces(Workers& workers) const;

 private:
  friend CheckedMesh check(Mesh mesh, std::size_t kept);
  CheckedMesh(Mesh mesh, std::size_t kept);

  Mesh mesh_;
  MeshFindings found_;
  std::optional<std::vector<FaceId>> meeting_;  ///< set once they have been looked for
};

/// Checks a mesh for everything but self-intersections. Keeps so many offenders of each finding.
CheckedMesh check(Mesh mesh, std::size_t kept = MeshFinding::kShown);

/// Checks the same without taking the mesh over. The findings are valid as long as nobody changes the
/// mesh.
MeshFindings examine(const Mesh& mesh, std::size_t kept = MeshFinding::kShown);

}  // namespace lrb
