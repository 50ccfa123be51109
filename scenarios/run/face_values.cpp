#include "scenarios/run/face_values.hpp"

#include <algorithm>

#include "trace/counters.hpp"
#include "trace/node_work.hpp"

namespace lrb::run {
namespace {

using ColourBy = render::FrameSpec::ColourBy;

const std::vector<std::uint32_t>& chosen(const trace::FaceCounts& counts, ColourBy by) {
  switch (by) {
    case ColourBy::refinements:
      return counts.refinements;
    case ColourBy::hits:
      return counts.hits;
    case ColourBy::misses:
      return counts.misses;
    case ColourBy::expansions:
      return counts.expansions;
    case ColourBy::plane_tests:
      return counts.plane_tests;
    default:
      return counts.tests;
  }
}

}  // namespace

std::vector<double> face_values(ColourBy by, const LrbRep& rep, Side side,
                                std::span<const trace::Event> events, const trace::TreeShape* tree) {
  if (by < ColourBy::face_tests) return {};
  if (by == ColourBy::box_tests) {
    if (tree == nullptr) return {};
    return trace::box_tests_by_face(rep, *tree, trace::count_nodes(*tree, side, events));
  }
  const trace::FaceCounts counts = trace::count_faces(rep, side, events);
  const std::vector<std::uint32_t>& numbers = chosen(counts, by);
  return {numbers.begin(), numbers.end()};
}

std::array<double, 2> scale_without_the_smallest(std::span<const std::vector<double>> values) {
  constexpr double kFew = 0.02;
  double high = 0;
  for (const std::vector<double>& of_body : values)
    for (const double v : of_body) high = std::max(high, v);
  return {kFew * high, high};
}

}  // namespace lrb::run
