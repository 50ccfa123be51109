// Boxes of tree nodes in pictures: those that the walk came to, and no others.
#include <algorithm>

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/frames/face_colours.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::run {
namespace {

const render::Style& kStyle = render::style_of(render::StyleName::screen);

}  // namespace

TEST_CASE("visited node boxes of a depth are drawn, solid if they overlapped") {
  const LrbRep ball = build_lrb(shapes::icosphere(4));
  trace::RecorderSettings settings;
  settings.level = EventLevel::nodes;
  trace::Recorder recorder(ball, ball, settings);
  const Pose pose = Pose::translation({1.8, 0.2, 0.1});
  recorder.begin_step(0, {}, pose);
  QueryContext context;
  recorder.end_step(collide(ball, {}, ball, pose, {}, context, recorder));
  const trace::Trace t = recorder.take();
  const trace::TreeShape tree(ball.tree());
  const trace::NodeCounts counts = trace::count_nodes(tree, Side::b, t.events);
  bool some_left_out = false;
  for (std::uint32_t depth = 0; depth < ball.tree().height(); ++depth) {
    std::size_t met = 0, rejected = 0;
    for (std::uint32_t n = 0; n < tree.size(); ++n) {
      if (tree.depth(n) != depth) continue;
      some_left_out |= counts.visits[n] == 0;
      if (counts.visits[n] > 0) ++(counts.ended[n] < counts.visits[n] ? met : rejected);
    }
    render::Scene scene;
    add_node_boxes(scene, tree, Side::b, pose, depth, t.events, kStyle);
    constexpr std::size_t kLines = 6;  // two ends, and four edges between them
    const auto dashed = static_cast<std::size_t>(std::count_if(
        scene.list.lines.begin(), scene.list.lines.end(), [](const auto& l) { return l.dash > 0; }));
    CHECK(scene.list.lines.size() == kLines * (met + rejected));
    CHECK(dashed == kLines * rejected);
    CHECK(scene.key.size() == (met > 0) + (rejected > 0));
    CHECK(met + rejected > 0);
  }
  CHECK(some_left_out);
  render::Scene deeper;
  add_node_boxes(deeper, tree, Side::b, pose, 60, t.events, kStyle);
  CHECK(deeper.list.lines.empty());
  // The root's box holds the body where it is.
  render::Scene root;
  add_node_boxes(root, tree, Side::b, pose, 0, t.events, kStyle);
  Eigen::AlignedBox3d box;
  for (const render::DrawLine& line : root.list.lines)
    for (const Eigen::Vector3d& x : line.points) box.extend(x);
  for (const Eigen::Vector3d& v : ball.vertices())
    if (v.norm() < 1.001) CHECK(box.contains(pose.apply(v)));
}

}  // namespace lrb::run
