#include "engine/build/build.hpp"

#include <algorithm>

#include "engine/build/chain_builder.hpp"
#include "engine/build/patch_builder.hpp"
#include "engine/error.hpp"
#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/mesh_check.hpp"
#include "engine/mesh/self_intersections.hpp"

namespace lrb {
namespace {

/// All that forbids an LRB-rep, on one line.
std::string refusal(const Mesh& mesh, const MeshReport& report) {
  std::string text;
  for (std::size_t i = 0; i < kMeshFaultCount; ++i) {
    MeshReport alone;
    alone.findings[i] = report.findings[i];
    if (alone.buildable() && static_cast<MeshFault>(i) != MeshFault::inside_out) continue;
    for (const std::string& line : alone.lines(mesh)) text += (text.empty() ? "" : " | ") + line;
  }
  return text;
}

}  // namespace

LrbRep build_lrb(const Mesh& mesh, const BuildOptions& options) {
  const MeshReport report = check_mesh(mesh, false);
  if (!report.buildable() || report[MeshFault::inside_out].count > 0) throw InputError(refusal(mesh, report));
  MeshReport unused;
  const std::vector<FaceUse> use = check_faces(mesh, unused);
  std::vector<FaceId> meeting;
  find_self_intersections(mesh, use, [&](FaceId f, FaceId g) { meeting.insert(meeting.end(), {f, g}); });
  std::sort(meeting.begin(), meeting.end());
  meeting.erase(std::unique(meeting.begin(), meeting.end()), meeting.end());
  bool crossing = false;
  if (!meeting.empty()) {
    const auto meets = [&](FaceId f) { return std::binary_search(meeting.begin(), meeting.end(), f); };
    find_crossings(
        mesh, use, [&](FaceId f, FaceId g) { return !crossing && meets(f) && meets(g); },
        [&](FaceId, FaceId) { crossing = true; });
  }
  LrbData data =
      mesh.dim == 2 ? build_by_chains(mesh, meeting, options) : build_by_patches(mesh, meeting, options);
  data.self_intersecting = crossing;
  return LrbRep(std::move(data));
}

}  // namespace lrb
