#pragma once
/// A mesh together with the findings of its checks, so that no check runs twice.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/parallel.hpp"
#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/mesh.hpp"
#include "engine/mesh/mesh_check.hpp"
#include "engine/mesh/surface_topology.hpp"

namespace lrb {

/// Everything that checking a mesh once finds out.
struct MeshFindings {
  MeshReport report;
  std::vector<FaceUse> use;  ///< (|F|)
  SurfaceTopology topology;
  std::vector<std::vector<FaceId>> inside_out;  ///< the faces of each component that faces the wrong way
  std::vector<bool> sheet;                      ///< (components) MeshReport::sheets counts them
};

/// A mesh that has been checked. Only check() makes one, and only turn_outward() changes its mesh, so that a
/// function that takes one can rely on its report and need not check the mesh again.
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

  /// Turns the components that are inside out (see orient_outward()) and returns their number. The report no
  /// longer names them.
  std::uint32_t turn_outward();

  /// Looks for pairs of faces that meet in more than they share, which takes longer than all other checks,
  /// and adds them to the report. Does nothing if that has been done.
  void find_self_intersections();
  /// Returns the faces in such pairs, ascending: those that find_self_intersections() found. If it was not
  /// called, finds them now, which is faster because pairs are not counted.
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

/// Checks the same without taking the mesh over. The findings are valid as long as nobody changes the mesh.
MeshFindings examine(const Mesh& mesh, std::size_t kept = MeshFinding::kShown);

}  // namespace lrb
