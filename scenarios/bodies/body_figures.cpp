#include "scenarios/bodies/body_figures.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "engine/exact/predicates.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::bodies {

double hull_volume(std::span<const Eigen::Vector3d> points) {
  const std::vector<std::array<std::uint32_t, 3>> hull = convex_hull(points);
  if (hull.empty()) return 0;
  const Eigen::Vector3d o = points[hull[0][0]];
  double six = 0;
  for (const auto& [a, b, c] : hull) six += (points[a] - o).dot((points[b] - o).cross(points[c] - o));
  return six / 6;
}

double hull_area(std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> p(points.begin(), points.end());
  std::sort(p.begin(), p.end(),
            [](const auto& a, const auto& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  double twice = 0;
  for (int half = 0; half < 2; ++half) {  // Andrew's monotone chain: the lower half, then the upper one
    std::vector<Eigen::Vector3d> chain;
    for (const Eigen::Vector3d& x : p) {
      while (chain.size() > 1 &&
             exact::orient2d(chain[chain.size() - 2].data(), chain.back().data(), x.data()) <= 0)
        chain.pop_back();
      chain.push_back(x);
    }
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      twice += chain[i].x() * chain[i + 1].y() - chain[i].y() * chain[i + 1].x();
    std::reverse(p.begin(), p.end());
  }
  return twice / 2;
}

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

double largest_side(const LrbRep& rep) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(rep.vertices()[v]);
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

Wrapper wrapper_at(const LrbRep& rep, double tolerance, unsigned threads) {
  // Empty: no region is included at any tolerance.
  const std::span<const double> needed = rep.levels(threads).needed();
  Wrapper wrapper(rep);
  for (RegionId r = 0; r < rep.region_count(); ++r)
    if (needed.empty() || !(needed[r] <= tolerance)) wrapper.refine(r);
  return wrapper;
}

std::vector<LevelFigures> level_figures(const LrbRep& rep, std::span<const double> shares, unsigned threads) {
  const std::span<const double> needed = rep.levels(threads).needed();
  const double size = largest_side(rep);
  std::vector<LevelFigures> out;
  for (const double share : shares) {
    LevelFigures level{share, share * size, 0, 0};
    const Wrapper wrapper = wrapper_at(rep, level.tolerance, threads);
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (wrapper.included(r)) level.bound = std::max(level.bound, needed[r]);
    level.faces = static_cast<std::uint32_t>(wrapper.boundary_size());
    out.push_back(level);
  }
  return out;
}

nlohmann::ordered_json level_json(std::span<const LevelFigures> levels) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const LevelFigures& l : levels)
    out.push_back({{"share", l.share}, {"tolerance", l.tolerance}, {"faces", l.faces}, {"bound", l.bound}});
  return out;
}

}  // namespace lrb::bodies
