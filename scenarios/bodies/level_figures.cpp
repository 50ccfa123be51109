#include "scenarios/bodies/level_figures.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/lrb/wrapper_level.hpp"

namespace lrb::bodies {

double largest_side(const LrbRep& rep) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(rep.vertices()[v]);
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

Wrapper wrapper_at(const LrbRep& rep, double tolerance, unsigned threads) {
  const std::span<const double> needed = rep.levels(threads).needed();  // empty: no region is ever included
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

}  // namespace lrb::bodies
