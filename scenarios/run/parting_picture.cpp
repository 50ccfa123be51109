#include "scenarios/run/parting_picture.hpp"

#include <array>
#include <vector>

#include "render/overlay.hpp"
#include "render/palette.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "scenarios/run/box_lines.hpp"
#include "scenarios/run/parting_square.hpp"

namespace lrb::run {
namespace {

constexpr int kPartingWidth = 1200, kPartingHeight = 900;
constexpr float kLine = 1.5F, kStrip = 3;

void add_square(render::DrawList& list, const Square& corners, int dim) {
  render::DrawLine rim;
  rim.colour = kPartingColour;
  rim.layer = render::Layer::translucent;
  if (dim == 2) {
    rim.points = {corners[0], corners[1]};
    rim.width = kStrip;
    list.lines.push_back(rim);
    return;
  }
  render::DrawTriangle like;
  like.colour = kPartingColour;
  like.colour.a = 90;
  like.layer = render::Layer::translucent;
  like.lit = false;
  list.add_polygon({corners.begin(), corners.end()}, like);
  rim.points = {corners.begin(), corners.end()};
  rim.closed = true;
  rim.width = kLine;
  list.lines.push_back(rim);
}

}  // namespace

void add_parting(render::DrawList& list, const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a,
                 const LrbRep& b, const Pose& pose_b, const render::Style& style) {
  const auto& boxes = walk.nearest_boxes;
  if (walk.plane) {
    add_square(list, parting_square(*walk.plane, a, pose_a, b, pose_b), a.dim());
  } else if (boxes) {
    for (const Side side : {Side::a, Side::b}) {
      const WorldBox& box = boxes->boxes[static_cast<std::size_t>(side)];
      BoxLook look;
      look.colour = style.edge_of(style.body(side));
      look.width = kLine;
      add_box(list, box.centre, box.half, look);
    }
    add_square(list, parting_square(*boxes, a.dim()), a.dim());
  }
}

std::string parting_words(const WalkExplanation& walk) {
  if (walk.plane) return "a plane parts them, gap " + render::short_number(walk.plane->gap());
  if (walk.nearest_boxes) return "boxes part them, gap " + render::short_number(walk.nearest_boxes->pair.gap);
  return {};
}

void draw_parting(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const WalkExplanation& walk, const std::string& path) {
  std::array<render::SceneBody, 2> bodies;
  bodies[0].rep = &a;
  bodies[0].pose = pose_a;
  bodies[0].name = "A " + a.name();
  bodies[1].rep = &b;
  bodies[1].pose = pose_b;
  bodies[1].name = "B " + b.name();
  render::Scene scene = render::build_scene(bodies, {});
  add_parting(scene.list, walk, a, pose_a, b, pose_b, render::style_of(render::StyleName::screen));
  render::Overlay overlay;
  overlay.title = a.name() + "  ·  " + b.name();
  overlay.event = std::string(name_of(walk.result.relation));
  if (const std::string words = parting_words(walk); !words.empty()) overlay.event += ": " + words;
  overlay.event_colour = kPartingColour;
  overlay.key = scene.key;
  const render::OverlayLayout layout = render::lay_out(overlay, kPartingWidth, kPartingHeight);
  std::vector<Eigen::Vector3d> points = render::body_points(a, pose_a);
  for (const Eigen::Vector3d& x : render::body_points(b, pose_b)) points.push_back(x);
  render::RasterOptions options;
  options.width = layout.picture.width;
  options.height = layout.picture.height;
  const render::Camera camera = a.dim() == 2 ? render::fit_top(points, options.width, options.height)
                                             : render::fit_camera(points, options.width, options.height);
  render::Rasterizer rasterizer;
  render::write_png(render::compose_frame(rasterizer.draw(scene.list, camera, options), layout.picture,
                                          overlay, kPartingWidth, kPartingHeight),
                    path);
}

}  // namespace lrb::run
