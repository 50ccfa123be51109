#include "engine/lrb/wrapper_level.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/lrb/pieces.hpp"
#include "engine/lrb/thickness.hpp"
#include "engine/lrb/wrapper.hpp"

namespace lrb {
namespace {

// The number of levels kept; without a limit, a sweep over tolerances would keep one for each.
constexpr std::size_t kMostLevels = 24;

/// Returns, for each region, the largest thickness among the region and all that it hides. Passes values
/// outward until none grows.
std::vector<double> needed_tolerances(const LrbRep& rep) {
  std::vector<double> needed = region_thickness(rep);
  std::vector<RegionId> work(rep.region_count());
  std::iota(work.begin(), work.end(), RegionId{0});
  while (!work.empty()) {
    const RegionId r = work.back();
    work.pop_back();
    for (const FaceId lid : rep.lids(r)) {
      const CellId over = rep.outer_cell(lid);
      if (!is_region(over) || needed[over] >= needed[r]) continue;
      needed[over] = needed[r];
      work.push_back(over.as_region());
    }
  }
  return needed;
}

}  // namespace

WrapperLevels::WrapperLevels(const LrbRep& rep) : rep_(rep) {
  if (!rep.closed() || rep.self_intersecting()) return;
  needed_ = needed_tolerances(rep);
  for (const double x : needed_) {
    if (!std::isfinite(x)) continue;
    largest_ = std::max(largest_, x);
    smallest_ = smallest_ == 0 ? x : std::min(smallest_, x);
  }
}

const WrapperLevel& WrapperLevels::at(double tolerance) {
  for (const auto& level : levels_)
    if (level->tolerance == tolerance) return *level;
  auto level = make(tolerance);
  if (levels_.size() == kMostLevels) levels_.clear();
  levels_.push_back(std::move(level));
  return *levels_.back();
}

std::unique_ptr<WrapperLevel> WrapperLevels::make(double tolerance) const {
  auto level = std::make_unique<WrapperLevel>();
  level->tolerance = tolerance;
  Wrapper wrapper(rep_);
  for (RegionId r = 0; r < rep_.region_count(); ++r) {
    if (!needed_.empty() && needed_[r] <= tolerance)
      level->bound = std::max(level->bound, needed_[r]);
    else
      wrapper.refine(r);
  }
  std::vector<SimplexId> simplices;
  const std::vector<FaceId> faces = wrapper.boundary();
  for (const FaceId f : faces) {
    level->pseudo_count += !rep_.is_real(f);
    const std::size_t count = Mesh::simplices_of(rep_.face(f).size(), rep_.dim());
    for (std::size_t i = 0; i < count; ++i) simplices.emplace_back(rep_.first_simplex(f) + i);
  }
  level->face_count = static_cast<std::uint32_t>(faces.size());
  level->component_vertices = piece_vertices(rep_, faces);
  level->tree = ObbTree(rep_.simplices(), simplices);
  return level;
}

}  // namespace lrb
