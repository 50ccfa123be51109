#include "scenarios/frames/face_colours.hpp"

#include <algorithm>

#include "render/pictures/marks.hpp"
#include <lrbscope/trace/counters.hpp>
namespace lrb::frames {

std::uint32_t region_of(const LrbRep& rep, FaceId face) {
  const CellId cell = rep.is_real(face) ? rep.outer_cell(face) : rep.inner_cell(face);
  return is_region(cell) ? cell.as_region().value() : std::uint32_t{kNull};
}

std::uint32_t level_of(const LrbRep& rep, FaceId face) {
  const CellId cell = rep.outer_cell(face);
  return is_region(cell) ? rep.depth(cell.as_region()) : 0;
}

std::vector<double> grouped(std::vector<double> values, pictures::FrameSpec::ColourPer per,
                            const LrbRep& rep) {
  using ColourPer = pictures::FrameSpec::ColourPer;
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

namespace {

using ColourBy = pictures::FrameSpec::ColourBy;

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

namespace {

struct LabelledStyle {
  pictures::BoxStyle lines;
  const char* label;
};

LabelledStyle style_of_boxes(Side side, bool met, const render::Style& style) {
  static constexpr const char* kWords[2][2] = {{"A: disjoint node boxes", "A: overlapping node boxes"},
                                               {"B: disjoint node boxes", "B: overlapping node boxes"}};
  const render::Rgba colour = style.edge_of(style.body(side));
  return {met ? pictures::BoxStyle{colour, 2, 0} : pictures::BoxStyle{colour, 1, 4},
          kWords[static_cast<int>(side)][met ? 1 : 0]};
}

}  // namespace

void add_node_boxes(render::Scene& scene, const trace::TreeShape& tree, Side side, const Pose& pose,
                    std::uint32_t depth, std::span<const trace::Event> events, const render::Style& style) {
  const trace::NodeCounts counts = trace::count_nodes(tree, side, events);
  std::array<bool, 2> any{};
  for (std::uint32_t n = 0; n < tree.size(); ++n) {
    if (tree.depth(n) != depth || counts.visits[n] == 0) continue;
    const bool met = counts.ended[n] < counts.visits[n];
    const trace::ShapeBox box = tree.box(n);
    std::array<Eigen::Vector3d, 3> half;
    for (std::size_t i = 0; i < half.size(); ++i) half[i] = pose.r * box.half[i];
    pictures::add_box(scene.list, pose.apply(box.centre), half, style_of_boxes(side, met, style).lines);
    any[met ? 1 : 0] = true;
  }
  for (const bool met : {true, false})
    if (any[met ? 1 : 0])
      scene.key.push_back({met ? render::LegendItem::Mark::line : render::LegendItem::Mark::dashed,
                           style_of_boxes(side, met, style).lines.colour,
                           style_of_boxes(side, met, style).label});
}

}  // namespace lrb::frames
