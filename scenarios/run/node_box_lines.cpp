#include "scenarios/run/node_box_lines.hpp"

#include <algorithm>

#include "scenarios/run/box_lines.hpp"
#include "trace/node_work.hpp"

namespace lrb::run {
namespace {

struct Look {
  BoxLook lines;
  const char* words;
};

Look look_of(Side side, bool met, const render::Style& style) {
  static constexpr const char* kWords[2][2] = {
      {"A: boxes of nodes that parted", "A: boxes of nodes that met"},
      {"B: boxes of nodes that parted", "B: boxes of nodes that met"}};
  const render::Rgba colour = style.edge_of(style.body(side));
  return {met ? BoxLook{colour, 2, 0} : BoxLook{colour, 1, 4}, kWords[static_cast<int>(side)][met ? 1 : 0]};
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
    add_box(scene.list, pose.apply(box.centre), half, look_of(side, met, style).lines);
    any[met ? 1 : 0] = true;
  }
  for (const bool met : {true, false})
    if (any[met ? 1 : 0])
      scene.key.push_back({met ? render::LegendItem::Mark::line : render::LegendItem::Mark::dashed,
                           look_of(side, met, style).lines.colour, look_of(side, met, style).words});
}

}  // namespace lrb::run
