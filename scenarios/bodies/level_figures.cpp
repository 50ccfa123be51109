#include "scenarios/bodies/level_figures.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include "engine/lrb/thickness.hpp"

namespace lrb::bodies {
namespace {

/// Returns, for each region, the largest thickness among the region and all that it hides.
std::vector<double> needed_tolerances(const LrbRep& rep, unsigned threads) {
  if (!rep.closed() || rep.self_intersecting())
    return std::vector<double>(rep.region_count(), std::numeric_limits<double>::infinity());
  std::vector<double> needed = region_thickness(rep, threads);
  std::vector<RegionId> work(rep.region_count());
  std::iota(work.begin(), work.end(), RegionId{0});
  while (!work.empty()) {
    const RegionId r = work.back();
    work.pop_back();
    for (const FaceId lid : rep.lids(r)) {
      const CellId over = rep.outer_cell(lid);
      if (!is_region(over) || needed[over] >= needed[r]) continue;
      needed[over] = needed[r];
      work.push_back(over);
    }
  }
  return needed;
}

double largest_side(const LrbRep& rep) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(rep.vertices()[v]);
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

}  // namespace

std::vector<LevelFigures> level_figures(const LrbRep& rep, std::span<const double> shares, unsigned threads) {
  const std::vector<double> needed = needed_tolerances(rep, threads);
  const double size = largest_side(rep);
  std::vector<LevelFigures> out;
  for (const double share : shares) {
    LevelFigures level{share, share * size, 0, 0};
    const auto includes = [&](CellId c) { return is_region(c) && needed[c] <= level.tolerance; };
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (includes(r)) level.bound = std::max(level.bound, needed[r]);
    for (FaceId f = 0; f < rep.face_count(); ++f)
      level.faces += (rep.is_real(f) || includes(rep.inner_cell(f))) && !includes(rep.outer_cell(f));
    out.push_back(level);
  }
  return out;
}

}  // namespace lrb::bodies
