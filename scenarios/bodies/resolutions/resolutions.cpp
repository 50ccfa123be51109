#include "scenarios/bodies/resolutions/resolutions.hpp"

#include "engine/core/error.hpp"
#include "engine/mesh/mesh_check.hpp"
#include "scenarios/bodies/resolutions/decimate.hpp"
#include "scenarios/bodies/resolutions/subdivide.hpp"

namespace lrb::resolutions {

std::vector<Mesh> resolutions(const Mesh& mesh, const ResolutionOptions& options) {
  const MeshReport report = check_mesh(mesh, false).when_turned();
  if (mesh.dim != 3)
    throw InputError(mesh.name + ": a body in the plane has no resolutions; give one in space");
  if (!report.buildable()) {
    const std::vector<std::string> obstacles = report.obstacles(mesh);
    throw InputError(obstacles.empty() ? mesh.name + ": no LRB-rep can be built of it" : obstacles.front());
  }
  const std::uint32_t all[] = {~0u};
  Mesh finest = decimate(mesh, all).front();  // without any collapse: only turns polygons into triangles
  for (std::uint32_t i = 0; i < options.subdivisions; ++i) finest = subdivide(finest);
  orient_outward(finest);
  std::vector<std::uint32_t> targets;
  for (auto n = static_cast<std::uint32_t>(finest.face_count() / 2);
       n >= options.least_faces && targets.size() + 1 < options.most; n /= 2)
    targets.push_back(n);
  std::vector<Mesh> out = decimate(finest, targets);
  out.insert(out.begin(), std::move(finest));
  return out;
}

}  // namespace lrb::resolutions
