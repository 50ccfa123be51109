#include "engine/construct/build.hpp"

#include "engine/construct/chain_builder.hpp"
#include "engine/construct/patch_builder.hpp"
#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/mesh_check.hpp"
#include "engine/mesh/self_intersections.hpp"

namespace lrb {
namespace {

/// Returns everything that prevents an LRB-rep from being built, on one line.
std::string refusal(const Mesh& mesh, const MeshReport& report) {
  std::vector<std::string> lines = report.obstacles(mesh);
  if (lines.empty()) lines = report.lines(mesh);  // an inside-out mesh could be built, but not as it is
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : " | ") + line;
  return text;
}

}  // namespace

LrbRep build_lrb(const Mesh& mesh, const BuildOptions& options) {
  const MeshReport report = check_mesh(mesh, false);
  if (!report.buildable() || report[MeshFault::inside_out].count > 0) throw InputError(refusal(mesh, report));
  Workers workers(options.threads);
  MeshReport unused;
  const std::vector<FaceUse> use = check_faces(mesh, unused);
  const std::vector<FaceId> meeting = self_intersecting_faces(mesh, use, workers);
  bool overlapping = false;
  if (!meeting.empty()) {
    const auto meets = [&](FaceId f) { return std::binary_search(meeting.begin(), meeting.end(), f); };
    find_overlaps(
        mesh, use, [&](FaceId f, FaceId g) { return !overlapping && meets(f) && meets(g); },
        [&](FaceId, FaceId) { overlapping = true; });
  }
  LrbData data = mesh.dim == 2 ? construct::build_by_chains(mesh, meeting, options)
                               : construct::build_by_patches(mesh, meeting, options);
  data.self_intersecting = overlapping;
  return LrbRep(std::move(data), options.threads);
}

}  // namespace lrb
