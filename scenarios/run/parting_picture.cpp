#include "scenarios/run/parting_picture.hpp"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "engine/query/distance/distance.hpp"
#include "render/overlay.hpp"
#include "render/palette.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "scenarios/io/number_text.hpp"
#include "scenarios/run/box_lines.hpp"
#include "scenarios/run/frame_files.hpp"
#include "scenarios/run/parting_square.hpp"

namespace lrb::run {
namespace {

using Eigen::Vector3d;

constexpr int kPartingWidth = 1600, kPartingHeight = 900;
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

/// Draws the nearest of the boxes that the walk found apart. `through`: as BoxLook has it.
void add_boxes(render::DrawList& list, const PartedBoxes& boxes, const render::Style& style, bool through) {
  for (const Side side : {Side::a, Side::b}) {
    const WorldBox& box = boxes.boxes[static_cast<std::size_t>(side)];
    BoxLook look;
    look.colour = style.edge_of(style.body(side));
    look.width = kLine;
    look.through = through;
    add_box(list, box.centre, box.half, look);
  }
}

std::vector<Vector3d> corners_of_box(const WorldBox& box) {
  std::vector<Vector3d> out;
  for (int i = 0; i < 8; ++i)
    out.emplace_back(box.centre + (i & 1 ? 1 : -1) * box.half[0] + (i & 2 ? 1 : -1) * box.half[1] +
                     (i & 4 ? 1 : -1) * box.half[2]);
  return out;
}

/// Returns what a close-up has to show: where both bodies reach nearest to the plane, or both boxes.
std::vector<Vector3d> close_points(const WalkExplanation& walk) {
  if (walk.plane) return {walk.plane->reach.begin(), walk.plane->reach.end()};
  std::vector<Vector3d> out;
  for (const WorldBox& box : walk.nearest_boxes->boxes)
    for (const Vector3d& x : corners_of_box(box)) out.push_back(x);
  return out;
}

/// Returns a camera that looks from near by, and along the plane, so that the gap is seen. `whole`: all that
/// there is.
render::Camera close_camera(const WalkExplanation& walk, const Square& square, int dim,
                            const std::vector<Vector3d>& whole, const render::PixelRect& place) {
  constexpr double kContext = 1.5, kLeast = 0.03;
  std::vector<Vector3d> points = close_points(walk);
  Eigen::AlignedBox3d all, part;
  for (const Vector3d& x : whole) all.extend(x);
  for (const Vector3d& x : points) part.extend(x);
  if (dim == 2) {
    const double room = kLeast * all.diagonal().norm();
    for (const double way : {-room, room}) points.emplace_back(part.center() + Vector3d(way, way, 0));
    return render::fit_top(points, place.width, place.height, 0.2);
  }
  render::FitOptions fit;
  fit.view = render::view_beside((square[0] - square[2]).cross(square[1] - square[3]));
  return render::fit_contact(points, all, place.width, place.height, fit, kContext, kLeast);
}

std::vector<render::LegendItem> parting_key(const WalkExplanation& walk, int dim) {
  using Mark = render::LegendItem::Mark;
  std::vector<render::LegendItem> key;
  for (const Side side : {Side::a, Side::b})
    if (!walk.plane && walk.nearest_boxes)
      key.push_back({Mark::line, render::palette::edge_of(render::palette::body(side)),
                     "box of " + std::string(name_of(side)) + "'s"});
  key.push_back({dim == 2 ? Mark::line : Mark::translucent, kPartingColour,
                 walk.plane ? "plane that parts them" : "between the boxes"});
  return key;
}

}  // namespace

void add_parting(render::DrawList& list, const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a,
                 const LrbRep& b, const Pose& pose_b, const render::Style& style, bool through) {
  const std::optional<Square> square = parting_square(walk, a, pose_a, b, pose_b);
  if (!square) return;
  if (!walk.plane) add_boxes(list, *walk.nearest_boxes, style, through);
  add_square(list, *square, a.dim());
}

std::string parting_words(const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                          const Pose& pose_b) {
  if (!walk.plane && !walk.nearest_boxes) return {};
  // Not the gap of the plane or of the boxes: it can grow while the bodies approach.
  DistanceRequest request;
  request.relation = false;
  const double gap = distance(a, pose_a, b, pose_b, request).lower;
  return std::string(walk.plane ? "a plane parts them" : "boxes part them") +
         (gap > 0 ? ", gap >= " + io::lower_text(gap) : "");
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
  const render::Style& style = render::style_of(render::StyleName::screen);
  add_parting(scene.list, walk, a, pose_a, b, pose_b, style, true);
  const std::optional<Square> square = parting_square(walk, a, pose_a, b, pose_b);
  render::Overlay overlay;
  overlay.title = a.name() + "  ·  " + b.name();
  overlay.event = std::string(name_of(walk.result.relation));
  if (const std::string words = parting_words(walk, a, pose_a, b, pose_b); !words.empty())
    overlay.event += ": " + words;
  overlay.event_colour = kPartingColour;
  overlay.key = scene.key;
  render::FrameSpec spec;
  spec.views.emplace_back();
  if (square) {
    merge_key(overlay.key, parting_key(walk, a.dim()));
    spec.views.emplace_back();
    spec.views[0].title = "Whole";
    spec.views[1].title = "Where they come nearest to what parts them";
  }
  const render::PixelRect place = render::lay_out(overlay, kPartingWidth, kPartingHeight).picture;
  const std::vector<render::PixelRect> places = view_places(place, spec.views.size(), spec.scale());
  std::vector<Vector3d> points = render::body_points(a, pose_a);
  for (const Vector3d& x : render::body_points(b, pose_b)) points.push_back(x);
  const auto camera = [&](std::size_t view) {
    const render::PixelRect& at = places[view];
    if (view == 1) return close_camera(walk, *square, a.dim(), points, at);
    return a.dim() == 2 ? render::fit_top(points, at.width, at.height)
                        : render::fit_camera(points, at.width, at.height);
  };
  render::Rasterizer rasterizer;
  render::Image picture(place.width, place.height);
  paint_views(
      rasterizer, spec, spec.views, places, [&](const render::FrameSpec::View&) { return scene.list; },
      camera, picture);
  render::write_png(render::compose_frame(picture, place, overlay, kPartingWidth, kPartingHeight), path);
}

}  // namespace lrb::run
