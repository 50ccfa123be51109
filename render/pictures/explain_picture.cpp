#include "render/pictures/explain_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::run {
namespace {

using Eigen::Vector3d;

constexpr int kPairWidth = 1200, kPairHeight = 900;

/// Draws the corners of a contact, or the nearest points, and what they span.
void mark(render::DrawList& list, const std::vector<Vector3d>& points) {
  for (const Vector3d& x : points) add_mark(list, x, render::palette::kContact, 5);
  if (points.size() > 1) outline(list, points, render::palette::kContact, 4);
}

/// Draws a square of the plane across the line between two points, in its middle. `side`: its length.
void add_plane(render::DrawList& list, const std::array<Vector3d, 2>& nearest, double side) {
  const Vector3d normal = (nearest[1] - nearest[0]).normalized(), u = normal.unitOrthogonal() * (side / 2);
  const Vector3d v = normal.cross(u), middle = (nearest[0] + nearest[1]) / 2;
  render::DrawTriangle like;
  like.colour = render::palette::kGreen;
  like.colour.a = 90;
  like.layer = render::Layer::translucent;
  like.lit = false;
  list.add_polygon({middle + u + v, middle - u + v, middle - u - v, middle + u - v}, like);
}

/// Returns a direction from which both faces are seen from their fronts; where they look opposite ways, A's
/// from its front and B's from its back.
render::ViewDirection onto_both(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  constexpr double kOpposite = 0.5;  // of unit normals' sum
  const Vector3d of_a = (a[1] - a[0]).cross(a[2] - a[0]).stableNormalized(),
                 of_b = (b[1] - b[0]).cross(b[2] - b[0]).stableNormalized();
  const Vector3d sum = of_a + of_b;
  render::ViewDirection out;
  out.from = sum.norm() > kOpposite ? sum : Vector3d(of_a - of_b);
  constexpr double kSteep = 0.95;
  if (out.from.isZero()) return {};  // both are needles without a normal
  if (std::abs(out.from.normalized().z()) > kSteep) out.up = {0, 1, 0};
  return out;
}

render::Overlay overlay_of(const LrbRep& a, const LrbRep& b, const PairExplanation& pair,
                           std::vector<render::LegendItem> key) {
  render::Overlay out;
  out.title = a.name() + ", simplex " + std::to_string(pair.pair.a) + "  ·  " + b.name() + ", simplex " +
              std::to_string(pair.pair.b);
  const bool apart = pair.meet == exact::Meet::disjoint;
  out.event = apart                             ? "apart by " + render::short_number(pair.distance)
              : pair.meet == exact::Meet::cross ? "the faces cross"
                                                : "the faces touch";
  out.key = std::move(key);
  using Mark = render::LegendItem::Mark;
  out.key.push_back({Mark::line, render::palette::kContact, apart ? "nearest points" : "contact"});
  if (apart && a.dim() == 3)
    out.key.push_back({Mark::translucent, render::palette::kGreen, "plane that parts them"});
  return out;
}

}  // namespace

void draw_pair(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
               const PairExplanation& pair, const std::string& path) {
  std::array<render::SceneBody, 2> bodies;
  bodies[0].rep = &a;
  bodies[0].pose = pose_a;
  bodies[1].rep = &b;
  bodies[1].pose = pose_b;
  render::SceneHighlight highlight;
  highlight.under_test = {pair.pair.a, pair.pair.b};
  render::Scene scene = render::build_scene(bodies, highlight);
  const std::vector<Vector3d> of_a = corners_of(a, pose_a, pair.pair.a),
                              of_b = corners_of(b, pose_b, pair.pair.b);
  std::vector<Vector3d> both = of_a;
  both.insert(both.end(), of_b.begin(), of_b.end());
  Eigen::AlignedBox3d part, all;
  for (const Vector3d& x : both) part.extend(x);
  for (const render::SceneBody& body : bodies)
    for (const Vector3d& x : render::body_points(*body.rep, body.pose)) all.extend(x);
  outline(scene.list, of_a, render::palette::edge_of(render::palette::body(Side::a)), 3);
  outline(scene.list, of_b, render::palette::edge_of(render::palette::body(Side::b)), 3);
  if (pair.meet == exact::Meet::disjoint) {
    mark(scene.list, {pair.nearest[0], pair.nearest[1]});
    if (a.dim() == 3 && pair.distance > 0) add_plane(scene.list, pair.nearest, part.diagonal().norm());
  } else {
    std::vector<Vector3d> contact;
    contact.reserve(static_cast<std::size_t>(pair.contact.corner_count));
    for (int i = 0; i < pair.contact.corner_count; ++i) contact.push_back(pair.contact.corners[i].x);
    mark(scene.list, contact);
  }
  const render::Overlay overlay = overlay_of(a, b, pair, scene.key);
  const render::OverlayLayout layout = render::lay_out(overlay, kPairWidth, kPairHeight);
  render::FitOptions fit;
  const Vector3d across = pair.nearest[1] - pair.nearest[0];
  if (a.dim() == 3)
    fit.view = pair.meet == exact::Meet::disjoint && across.norm() > 0 ? render::view_beside(across)
                                                                       : onto_both(of_a, of_b);
  const render::Camera camera =
      a.dim() == 2
          ? render::fit_top(both, layout.picture.width, layout.picture.height, 0.3)
          : render::fit_contact(both, all, layout.picture.width, layout.picture.height, fit, 2.5, 0.001);
  render::RasterOptions options;
  options.width = layout.picture.width;
  options.height = layout.picture.height;
  render::Rasterizer rasterizer;
  const render::Image picture = rasterizer.draw(scene.list, camera, options);
  render::write_png(render::compose_frame(picture, layout.picture, overlay, kPairWidth, kPairHeight), path);
}

namespace {

/// Returns a square round a point that is carried into the plane n.x = at.
Square square(const Eigen::Vector3d& n, double at, Eigen::Vector3d middle, double half, int dim) {
  middle += n * (at - n.dot(middle));
  if (dim == 2) {
    const Eigen::Vector3d u = half * Eigen::Vector3d(-n.y(), n.x(), 0);
    return {middle + u, middle - u, middle - u, middle + u};
  }
  const Eigen::Vector3d u = half * n.unitOrthogonal(), v = n.cross(u);
  return {middle + u, middle + v, middle - u, middle - v};
}

}  // namespace

Square parting_square(const PartingPlane& plane, const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                      const Pose& pose_b) {
  constexpr double kShare = 0.35;  // of the smaller body's diagonal, from the middle to a corner
  const Eigen::AlignedBox3d of_a = box_with_lids(a, pose_a), of_b = box_with_lids(b, pose_b);
  const Eigen::AlignedBox3d& smaller = of_a.diagonal().norm() < of_b.diagonal().norm() ? of_a : of_b;
  return square(plane.normal, (plane.of_a + plane.of_b) / 2, smaller.center(),
                kShare * smaller.diagonal().norm(), a.dim());
}

Square parting_square(const PartedBoxes& parted, int dim) {
  const auto axis = static_cast<std::size_t>(parted.pair.axis);
  const auto& [a, b] = parted.boxes;
  Eigen::Vector3d normal = axis < 3 ? a.across[axis] : b.across[axis - 3];
  if (normal.dot(b.centre - a.centre) < 0) normal = -normal;
  double end_of_a = normal.dot(a.centre);
  for (const Eigen::Vector3d& h : a.half) end_of_a += std::abs(normal.dot(h));
  const auto size = [](const WorldBox& box) { return (box.half[0] + box.half[1] + box.half[2]).norm(); };
  return square(normal, end_of_a + parted.pair.gap / 2, (a.centre + b.centre) / 2, std::min(size(a), size(b)),
                dim);
}

std::optional<Square> parting_square(const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a,
                                     const LrbRep& b, const Pose& pose_b) {
  if (walk.plane) return parting_square(*walk.plane, a, pose_a, b, pose_b);
  if (walk.nearest_boxes) return parting_square(*walk.nearest_boxes, a.dim());
  return {};
}

namespace {

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

namespace {

constexpr int kWidth = 900, kHeight = 720;

render::Camera camera_of(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  std::vector<Eigen::Vector3d> points = render::body_points(a, pose_a);
  const std::vector<Eigen::Vector3d> of_b = render::body_points(b, pose_b);
  points.insert(points.end(), of_b.begin(), of_b.end());
  return a.dim() == 2 ? render::fit_top(points, kWidth, kHeight)
                      : render::fit_camera(points, kWidth, kHeight);
}

std::string caption(const std::string& what, const Wrapper& a, const Wrapper& b) {
  return what + ": " + render::group_digits(a.boundary_size()) + " and " +
         render::group_digits(b.boundary_size()) + " faces";
}

}  // namespace

void draw_separation(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const Separation& separation, const std::string& path) {
  const render::Camera camera = camera_of(a, pose_a, b, pose_b);
  render::RasterOptions options;
  options.width = kWidth;
  options.height = kHeight;
  render::Rasterizer rasterizer;
  Wrapper wrapper_a(a), wrapper_b(b);
  const auto panel = [&](const std::string& what) {
    std::vector<render::SceneBody> bodies(2);
    bodies[0].rep = &a;
    bodies[0].wrapper = &wrapper_a;
    bodies[0].pose = pose_a;
    bodies[1].rep = &b;
    bodies[1].wrapper = &wrapper_b;
    bodies[1].pose = pose_b;
    return render::Panel{rasterizer.draw(render::build_scene(bodies).list, camera, options),
                         caption(what, wrapper_a, wrapper_b)};
  };
  std::vector<render::Panel> panels = {panel("outermost wrappers")};
  for (const RegionId r : separation.refined[0]) wrapper_a.refine(r);
  for (const RegionId r : separation.refined[1]) wrapper_b.refine(r);
  panels.push_back(panel("apart"));
  render::write_png(render::montage(panels), path);
}

}  // namespace lrb::run
