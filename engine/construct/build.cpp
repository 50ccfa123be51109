#include "engine/construct/builders.hpp"
#include "engine/mesh/self_intersections.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {
namespace {

/// Returns all reasons why an LRB-rep cannot be built, on one line.
std::string rejection(const Mesh& mesh, const MeshReport& report) {
  // All obstacles at once, so that the user can fix them in one go.
  std::string text;
  for (const std::string& line : report.obstacles(mesh)) text += (text.empty() ? "" : " | ") + line;
  return text;
}

/// `meeting`: the faces that intersect others in more than shared vertices and edges.
LrbRep build(const Mesh& mesh, const std::vector<FaceUse>& use, const std::vector<FaceId>& meeting,
             const BuildOptions& options) {
  // Step 1: the faces that intersect others. Do interiors of the body overlap, or do its faces only touch?
  const auto meets = [&](FaceId f) { return std::binary_search(meeting.begin(), meeting.end(), f); };
  const bool overlapping = !meeting.empty() && overlaps_itself(mesh, use, [&](FaceId f, FaceId g) {
    return meets(f) && meets(g);
  });
  // Step 2: the regions, from the mesh outward.
  LrbData data = mesh.dim == 2 ? construct::build_by_chains(mesh, meeting, options)
                               : construct::build_by_collapses(mesh, meeting, options);
  // Step 3: the trees for queries are built by the LrbRep itself.
  data.self_intersecting = overlapping;
  return LrbRep(std::move(data), options.threads);
}

}  // namespace

LrbRep build_lrb(const CheckedMesh& checked, const BuildOptions& options) {
  // The mesh was checked before; its results are reused.
  if (!checked.report().buildable()) throw InputError(rejection(checked.mesh(), checked.report()));
  Workers workers(options.threads);
  return build(checked.mesh(), checked.use(), checked.self_intersecting_faces(workers), options);
}

LrbRep build_lrb(const Mesh& mesh, const BuildOptions& options) {
  // Reject meshes that cannot be built before the more expensive search for self-intersections.
  const MeshFindings found = examine(mesh);
  if (!found.report.buildable()) throw InputError(rejection(mesh, found.report));
  Workers workers(options.threads);
  return build(mesh, found.use, self_intersecting_faces(mesh, found.use, workers), options);
}

}  // namespace lrb
