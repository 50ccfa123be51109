#include "scenarios/run/face_groups.hpp"

#include <algorithm>

namespace lrb::run {

std::uint32_t region_of(const LrbRep& rep, FaceId face) {
  const CellId cell = rep.is_real(face) ? rep.outer_cell(face) : rep.inner_cell(face);
  return is_region(cell) ? cell.as_region().value() : std::uint32_t{kNull};
}

std::uint32_t level_of(const LrbRep& rep, FaceId face) {
  const CellId cell = rep.outer_cell(face);
  return is_region(cell) ? rep.depth(cell.as_region()) : 0;
}

std::vector<double> grouped(std::vector<double> values, render::FrameSpec::ColourPer per, const LrbRep& rep) {
  using ColourPer = render::FrameSpec::ColourPer;
  if (per == ColourPer::face || values.empty()) return values;
  const auto group = [&](FaceId f) {
    return per == ColourPer::region ? region_of(rep, f) : level_of(rep, f);
  };
  std::vector<double> sums;
  for (FaceId f = 0; f < values.size(); ++f) {
    if (group(f) == kNull) continue;
    sums.resize(std::max<std::size_t>(sums.size(), group(f) + std::size_t{1}));
    sums[group(f)] += values[f];
  }
  for (FaceId f = 0; f < values.size(); ++f)
    if (group(f) != kNull) values[f] = sums[group(f)];
  return values;
}

}  // namespace lrb::run
