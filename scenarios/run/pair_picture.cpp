#include "scenarios/run/pair_picture.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "render/overlay.hpp"
#include "render/palette.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "render/scene.hpp"
#include "scenarios/run/pair_lines.hpp"

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

}  // namespace lrb::run
