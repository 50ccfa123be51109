#include "render/pictures/answer_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::run {
namespace {

using Eigen::Vector3d;

/// What is smaller than this share of the bodies is shown from nearby, too.
constexpr double kSmall = 0.12;
constexpr int kGhosts = 4;

/// A picture before it is drawn.
struct AnswerPicture {
  render::Scene scene;
  render::Overlay overlay;
  std::vector<Vector3d> whole;         ///< what it shows
  std::vector<Vector3d> detail;        ///< what it is about; none: nothing in particular
  Vector3d across = Vector3d::Zero();  ///< a way that is to be seen from beside; 0: none
  int dim = 3;
};

Eigen::AlignedBox3d box_of_points(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : points) box.extend(x);
  return box;
}

void add_points(std::vector<Vector3d>& points, const LrbRep& rep, const Pose& pose) {
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) points.push_back(pose.apply(rep.vertices()[v]));
}

render::SceneBody body_of(const LrbRep& rep, const Pose& pose, const char* side) {
  render::SceneBody body;
  body.rep = &rep;
  body.pose = pose;
  body.name = std::string(side) + " " + rep.name();
  return body;
}

render::Scene scene_of(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                       std::span<const ContactRegion> contacts = {}) {
  const std::array<render::SceneBody, 2> bodies{body_of(a, pose_a, "A"), body_of(b, pose_b, "B")};
  render::SceneHighlight highlight;
  highlight.contacts = contacts;
  render::SceneOptions options;
  options.contact_rims = true;
  return render::build_scene(bodies, highlight, options);
}

/// Makes all faces ones that are seen through, and drops their edges.
void make_translucent(render::DrawList& list, std::uint8_t alpha) {
  for (render::DrawTriangle& t : list.triangles) {
    t.layer = render::Layer::translucent;
    t.colour.a = alpha;
    t.edges = 0;
  }
}

/// Adds B where it is not, to be seen through.
void add_ghost(render::Scene& scene, const LrbRep& b, const Pose& pose, std::uint8_t alpha) {
  render::SceneBody body = body_of(b, pose, "B");
  body.colour = render::palette::body(Side::b);
  render::SceneOptions options;
  options.real_edges = false;
  render::DrawList list = render::build_scene({&body, 1}, {}, options).list;
  make_translucent(list, alpha);
  for (render::DrawFill& fill : list.fills) fill.colour = render::mix(fill.colour, render::kWhite, 0.75);
  for (render::DrawLine& line : list.lines) line.colour.a = alpha;
  list.append(scene.list);  // under what is there
  scene.list = std::move(list);
}

render::FitOptions view_of(const AnswerPicture& p, const AnswerLook& look) {
  const Vector3d way = p.across.norm() > 0 ? p.across : look.up.unitOrthogonal();
  render::FitOptions fit;
  fit.view = render::view_beside(way, look.up);
  return fit;
}

render::Camera whole_camera(const AnswerPicture& p, const AnswerLook& look, const render::PixelRect& place) {
  return p.dim == 2 ? render::fit_top(p.whole, place.width, place.height)
                    : render::fit_camera(p.whole, place.width, place.height, view_of(p, look));
}

render::Camera near_camera(const AnswerPicture& p, const AnswerLook& look, const render::PixelRect& place) {
  constexpr double kContext = 4, kLeast = 0.001;
  if (p.dim == 3)
    return render::fit_contact(p.detail, box_of_points(p.whole), place.width, place.height, view_of(p, look),
                               kContext, kLeast);
  const Eigen::AlignedBox3d box = box_of_points(p.detail);
  const double half =
      std::max(kContext * box.diagonal().norm(), kLeast * box_of_points(p.whole).diagonal().norm()) / 2;
  const std::vector<Vector3d> corners{box.center() - Vector3d(half, half, 0),
                                      box.center() + Vector3d(half, half, 0)};
  return render::fit_top(corners, place.width, place.height);
}

/// Draws the whole and, if what it is about is small, that from nearby on its right.
void write_picture(AnswerPicture& p, const AnswerLook& look, const std::string& path) {
  p.overlay.key = p.scene.key;
  const render::OverlayLayout layout = render::lay_out(p.overlay, look.width, look.height);
  const double size = box_of_points(p.whole).diagonal().norm();
  const bool is_small = !p.detail.empty() && box_of_points(p.detail).diagonal().norm() < kSmall * size;
  render::FrameSpec spec;
  spec.height = look.height;  // the views' titles follow it
  std::vector<render::FrameSpec::View> views(is_small ? 2 : 1);
  if (is_small) views[1].title = "from nearby";
  const std::vector<render::PixelRect> places = view_places(layout.picture, views.size(), 1);
  render::Image picture(layout.picture.width, layout.picture.height);
  render::Rasterizer rasterizer;
  paint_views(
      rasterizer, spec, views, places, [&](const render::FrameSpec::View&) { return p.scene.list; },
      [&](std::size_t view) {
        return view == 0 ? whole_camera(p, look, places[0]) : near_camera(p, look, places[1]);
      },
      picture);
  make_folder_of(path);
  render::write_png(render::compose_frame(picture, layout.picture, p.overlay, look.width, look.height), path);
}

std::string digits(double value) {
  return io::number_text(value, 9);
}

void count_ends(render::Overlay& overlay, const std::string& what, double lower, double upper) {
  overlay.counters.push_back({what + " at least", digits(lower)});
  overlay.counters.push_back({"at most", std::isfinite(upper) ? digits(upper) : "not known"});
}

std::string title_of(const LrbRep& a, const LrbRep& b) {
  return a.name() + "  ·  " + b.name();
}

AnswerPicture begin(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  AnswerPicture p;
  p.dim = a.dim();
  p.overlay.title = title_of(a, b);
  add_points(p.whole, a, pose_a);
  add_points(p.whole, b, pose_b);
  return p;
}

void mark_point(render::Scene& scene, const Vector3d& x, const std::string& what) {
  add_mark(scene.list, x, render::palette::kContact, 5);
  scene.key.push_back({render::LegendItem::Mark::point, render::palette::kContact, what});
}

/// Draws the way of B's middle up to a time.
void add_path(AnswerPicture& p, const LrbRep& b, const Motion& motion, double until) {
  constexpr int kPieces = 64;
  const Vector3d middle = box_of_points(render::body_points(b, {})).center();
  render::DrawLine line;
  for (int i = 0; i <= kPieces; ++i) line.points.push_back(motion.at(until * i / kPieces).apply(middle));
  line.colour = render::palette::kFaint;
  line.width = 1.5F;
  line.dash = 6;
  line.layer = render::Layer::on_top;
  p.scene.list.lines.push_back(line);
  p.scene.key.push_back({render::LegendItem::Mark::dashed, render::palette::kFaint, "way of B's middle"});
}

std::string outcome_words(const FirstContactResult& r) {
  if (r.at_start) return "in contact from the start";
  if (r.outcome == MotionOutcome::never) return "they never meet";
  if (r.outcome == MotionOutcome::undecided) return "they come as near as rounding: undecided";
  return "first contact at t = " + digits(r.t1) + (r.passed ? ", passing through" : "");
}

}  // namespace

void draw_distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                   const DistanceResult& result, const AnswerLook& look, const std::string& path) {
  AnswerPicture p = begin(a, pose_a, b, pose_b);
  p.scene = scene_of(a, pose_a, b, pose_b);
  p.overlay.event_colour = kGapColour;
  if (const auto gap =
          gap_of({result.lower, result.upper}, result.witness[0].point, result.witness[1].point)) {
    add_gap(p.scene, *gap, render::style_of(render::StyleName::screen));
    p.detail = {gap->from, gap->to};
    p.across = gap->to - gap->from;
    p.overlay.event = gap->text + " apart" + (result.solids_meet() ? ", one inside the other" : "");
  } else if (result.meet) {
    mark_point(p.scene, result.witness[0].point, "a point of both");
    p.overlay.event = "the surfaces meet";
  } else {
    p.overlay.event = "not told apart";
  }
  count_ends(p.overlay, "distance", result.lower, result.upper);
  write_picture(p, look, path);
}

void draw_first_contact(const LrbRep& a, const LrbRep& b, const Motion& motion_b,
                        const FirstContactResult& result, const AnswerLook& look, const std::string& path) {
  const double last = result.is_contact() ? result.t1 : 1;
  const Pose at_last = motion_b.at(last);
  AnswerPicture p = begin(a, {}, b, at_last);
  p.scene = scene_of(a, {}, b, at_last);
  for (int i = kGhosts - 1; i >= 0 && last > 0; --i) {
    const Pose before = motion_b.at(last * i / kGhosts);
    add_ghost(p.scene, b, before, 52);
    add_points(p.whole, b, before);
  }
  if (last > 0) {
    p.scene.key.push_back({render::LegendItem::Mark::translucent, render::palette::body(Side::b),
                           "B at " + std::to_string(kGhosts) + " times before"});
    add_path(p, b, motion_b, last);
    p.across = at_last.t - motion_b.at(0).t;
  }
  if (result.is_contact() && result.witness[0].corner_count > 0)
    mark_point(p.scene, result.witness[0].point, "first contact");
  p.overlay.event = outcome_words(result);
  p.overlay.event_colour = render::palette::kContact;
  p.overlay.counters.push_back({"no contact before t", digits(result.t0)});
  if (result.is_contact())
    p.overlay.counters.push_back({"interval", render::short_number(result.t1 - result.t0)});
  write_picture(p, look, path);
}

void draw_clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                const ClashResult& result, const AnswerLook& look, const std::string& path) {
  AnswerPicture p = begin(a, pose_a, b, pose_b);
  CollideRequest request;
  request.contacts = true;
  const CollideResult found = collide(a, pose_a, b, pose_b, request);
  p.scene = scene_of(a, pose_a, b, pose_b, found.regions);
  p.overlay.title = kind_words(result.kind, result.reason) + "  ·  " + p.overlay.title;
  p.overlay.event_colour = kWayOutColour;
  if (const auto way = way_out_of(result.depth, result.translation, a, pose_a, b, pose_b, found.regions)) {
    Pose apart = pose_b;
    apart.t += result.translation;
    make_translucent(p.scene.list, 105);  // so that nothing hides the way out, nor contacts
    std::erase_if(p.scene.key, [](const render::LegendItem& item) { return item.text.ends_with("hidden"); });
    add_ghost(p.scene, b, apart, 26);
    add_points(p.whole, b, apart);
    add_way_out(p.scene, *way, p.dim);
    p.detail = {way->from, way->to};
    p.across = result.translation;
    p.overlay.event = way->text + " deep: B is apart when it has moved by the arrow";
    p.scene.key.push_back(
        {render::LegendItem::Mark::translucent, render::palette::body(Side::b), "B when it is apart"});
  } else {
    p.overlay.event = result.distance.upper > 0
                          ? interval_words(result.distance.lower, result.distance.upper) + " apart"
                          : "nothing has to move";
  }
  if (result.depth) count_ends(p.overlay, "depth", result.depth->lower, result.depth->upper);
  if (result.volume && result.volume->upper > 0)
    p.overlay.counters.push_back(
        {"volume shared", interval_words(result.volume->lower, result.volume->upper)});
  write_picture(p, look, path);
}

}  // namespace lrb::run
