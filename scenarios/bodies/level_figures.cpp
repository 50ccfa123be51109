#include "scenarios/bodies/level_figures.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/lrb/wrapper_level.hpp"

namespace lrb::bodies {
namespace {

double largest_side(const LrbRep& rep) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(rep.vertices()[v]);
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

}  // namespace

std::vector<LevelFigures> level_figures(const LrbRep& rep, std::span<const double> shares, unsigned threads) {
  const std::span<const double> needed = rep.levels(threads).needed();  // empty: no region is ever included
  const double size = largest_side(rep);
  std::vector<LevelFigures> out;
  for (const double share : shares) {
    LevelFigures level{share, share * size, 0, 0};
    const auto includes = [&](CellId c) {
      return !needed.empty() && is_region(c) && needed[c] <= level.tolerance;
    };
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (includes(r)) level.bound = std::max(level.bound, needed[r]);
    for (FaceId f = 0; f < rep.face_count(); ++f)
      level.faces += (rep.is_real(f) || includes(rep.inner_cell(f))) && !includes(rep.outer_cell(f));
    out.push_back(level);
  }
  return out;
}

}  // namespace lrb::bodies
