#include "scenarios/run/node_box_lines.hpp"

#include <algorithm>

#include "render/palette.hpp"
#include "trace/node_work.hpp"

namespace lrb::run {
namespace {

struct Look {
  render::Rgba colour;
  float width, dash;
  const char* words;
};

const Look& look_of(Side side, bool met) {
  using render::palette::body, render::palette::edge_of;
  static const Look looks[2][2] = {{{edge_of(body(Side::a)), 1, 4, "A: boxes of nodes that parted"},
                                    {edge_of(body(Side::a)), 2, 0, "A: boxes of nodes that met"}},
                                   {{edge_of(body(Side::b)), 1, 4, "B: boxes of nodes that parted"},
                                    {edge_of(body(Side::b)), 2, 0, "B: boxes of nodes that met"}}};
  return looks[static_cast<int>(side)][met ? 1 : 0];
}

/// Adds the twelve edges of a box: four round each end, and four between.
void add_box(render::DrawList& list, const trace::ShapeBox& box, const Pose& pose, const Look& look) {
  const auto corner = [&](int x, int y, int z) {
    return pose.apply(box.centre + (x * 2 - 1) * box.half[0] + (y * 2 - 1) * box.half[1] +
                      (z * 2 - 1) * box.half[2]);
  };
  render::DrawLine line;
  line.colour = look.colour;
  line.width = look.width;
  line.dash = look.dash;
  line.layer = render::Layer::translucent;
  for (int z = 0; z < 2; ++z) {
    line.points = {corner(0, 0, z), corner(1, 0, z), corner(1, 1, z), corner(0, 1, z)};
    line.closed = true;
    list.lines.push_back(line);
  }
  line.closed = false;
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y) {
      line.points = {corner(x, y, 0), corner(x, y, 1)};
      list.lines.push_back(line);
    }
}

}  // namespace

void add_node_boxes(render::Scene& scene, const trace::TreeShape& tree, Side side, const Pose& pose,
                    std::uint32_t depth, std::span<const trace::Event> events) {
  const trace::NodeCounts counts = trace::count_nodes(tree, side, events);
  std::array<bool, 2> any{};
  for (std::uint32_t n = 0; n < tree.size(); ++n) {
    if (tree.depth(n) != depth || counts.visits[n] == 0) continue;
    const bool met = counts.ended[n] < counts.visits[n];
    add_box(scene.list, tree.box(n), pose, look_of(side, met));
    any[met ? 1 : 0] = true;
  }
  for (const bool met : {true, false})
    if (any[met ? 1 : 0])
      scene.key.push_back({met ? render::LegendItem::Mark::line : render::LegendItem::Mark::dashed,
                           look_of(side, met).colour, look_of(side, met).words});
}

}  // namespace lrb::run
