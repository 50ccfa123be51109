#include "engine/mesh/checked_mesh.hpp"

#include <algorithm>

#include "engine/mesh/self_intersections.hpp"

namespace lrb {

CheckedMesh::CheckedMesh(Mesh mesh, std::size_t kept)
    : mesh_(std::move(mesh)), found_(examine(mesh_, kept)) {}

CheckedMesh check(Mesh mesh, std::size_t kept) {
  return {std::move(mesh), kept};
}

/// Neither uses nor topology change: a face has the same corners as before, its fan the same triangles, and
/// all neighbours in the component turn with it. Nor does what meets what.
std::uint32_t CheckedMesh::turn_outward() {
  const auto turned = static_cast<std::uint32_t>(found_.inside_out.size());
  turn_faces(mesh_, found_.inside_out);
  found_.inside_out.clear();
  found_.report = found_.report.when_turned();
  return turned;
}

void CheckedMesh::find_self_intersections() {
  if (meeting_) return;
  std::vector<bool> meets(mesh_.face_count(), false);
  lrb::find_self_intersections(mesh_, found_.use, [&](FaceId f, FaceId g) {
    note(found_.report, MeshFault::self_intersection, f, g);
    meets[f] = meets[g] = true;
  });
  sort_offenders(found_.report);
  found_.report.self_intersections_checked = true;
  meeting_.emplace();
  for (FaceId f = 0; f < meets.size(); ++f)
    if (meets[f]) meeting_->push_back(f);
}

std::vector<FaceId> CheckedMesh::self_intersecting_faces(Workers& workers) const {
  return meeting_ ? *meeting_ : lrb::self_intersecting_faces(mesh_, found_.use, workers);
}

}  // namespace lrb
