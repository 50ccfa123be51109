#pragma once
/// A mesh together with what is known of it, so that nobody need ask twice.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/parallel.hpp"
#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/mesh.hpp"
#include "engine/mesh/mesh_check.hpp"
#include "engine/mesh/surface_topology.hpp"

namespace lrb {

/// What one look at a mesh tells.
struct MeshFindings {
  MeshReport report;
  std::vector<FaceUse> use;  ///< (|F|)
  SurfaceTopology topology;
  std::vector<std::vector<FaceId>> inside_out;  ///< the faces of each component that faces the wrong way
};

/// A mesh that has been checked. Only check() makes one, and its mesh cannot be changed but by turn_outward():
/// whoever is handed one can rely on its report, and need not, and cannot, have the mesh checked again.
class CheckedMesh {
 public:
  const Mesh& mesh() const { return mesh_; }
  const MeshReport& report() const { return found_.report; }
  const std::vector<FaceUse>& use() const { return found_.use; }
  const SurfaceTopology& topology() const { return found_.topology; }

  /// Turns the components that are inside out (see orient_outward()) and returns their number. The report says
  /// so no more.
  std::uint32_t turn_outward();

  /// Looks for pairs of faces that meet in more than they share, which takes longer than all other checks, and
  /// adds them to the report. Does nothing if that has been done.
  void find_self_intersections();
  /// The faces in such pairs, ascending. Those that find_self_intersections() found, or, if nobody called it,
  /// found now: sooner, for the pairs are not counted.
  std::vector<FaceId> self_intersecting_faces(Workers& workers) const;

 private:
  friend CheckedMesh check(Mesh mesh);
  explicit CheckedMesh(Mesh mesh);

  Mesh mesh_;
  MeshFindings found_;
  std::optional<std::vector<FaceId>> meeting_;  ///< once it has been looked for
};

/// Checks all of a mesh but whether it intersects itself.
CheckedMesh check(Mesh mesh);

/// The same for a mesh that stays where it is: as good as long as nobody changes it.
MeshFindings examine(const Mesh& mesh);

}  // namespace lrb
