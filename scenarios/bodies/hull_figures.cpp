#include "scenarios/bodies/hull_figures.hpp"

#include "engine/lrb/validate.hpp"
#include "scenarios/bodies/hull_volume.hpp"

namespace lrb::bodies {

nlohmann::ordered_json body_figures(const LrbRep& rep) {
  const std::uint32_t real = rep.real_face_count(), total = rep.face_count();
  std::vector<FaceId> solid(real);
  for (FaceId f = 0; f < real; ++f) solid[f] = f;
  const std::vector<FaceId> outer(rep.outermost_faces().begin(), rep.outermost_faces().end());
  std::vector<bool> used(rep.vertices().size(), false);
  for (FaceId f = 0; f < real; ++f)
    for (const VertexId v : rep.face(f)) used[v] = true;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) points.push_back(rep.vertices()[v]);

  nlohmann::ordered_json j;
  j["name"] = rep.name();
  j["dim"] = rep.dim();
  j["closed"] = rep.closed();
  j["real_faces"] = real;
  j["pseudo_faces"] = total - real;
  j["total_faces"] = total;
  j["total_per_real"] = static_cast<double>(total) / std::max(1u, real);
  j["outer_faces"] = outer.size();
  j["regions"] = rep.region_count();
  j["layers"] = rep.layer_count();
  j["volume_solid"] = enclosed_volume(rep, solid);
  j["volume_outer"] = enclosed_volume(rep, outer);
  j["volume_hull"] = rep.dim() == 3 ? hull_volume(points) : hull_area(points);
  j["bytes"] = rep.memory_bytes();
  j["bytes_per_real_face"] = static_cast<double>(rep.memory_bytes()) / std::max(1u, real);
  return j;
}

}  // namespace lrb::bodies
