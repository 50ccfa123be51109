#include "scenarios/frames/framing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <lrbscope/distance.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>

namespace lrb::frames {
namespace {

using Eigen::Vector3d;

const Pose& step_pose(const trace::Step& step, std::size_t body) {
  return body == 0 ? step.pose_a : step.pose_b;
}

/// Returns a subset of points with almost the same extent: the extreme ones in a few dozen directions.
std::vector<Vector3d> extremes(const std::vector<Vector3d>& points) {
  constexpr int kTurns = 24, kRows = 7;
  std::vector<Vector3d> out;
  if (points.empty()) return out;
  for (int row = 0; row < kRows; ++row) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const double azimuth = 2 * std::numbers::pi * turn / kTurns;
      const double elevation = std::numbers::pi * (row - kRows / 2) / (kRows - 1);
      const Vector3d d(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                       std::sin(elevation));
      out.push_back(*std::max_element(points.begin(), points.end(),
                                      [&](const auto& p, const auto& q) { return p.dot(d) < q.dot(d); }));
    }
  }
  return out;
}

/// Returns the contacts that close-ups show. Coarse answers have no contact regions: the corners of all
/// intersecting faces.
std::vector<Vector3d> contacts_of(const RecordedRun& p) {
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < p.trace->steps.size(); ++i) {
    const std::vector<std::size_t>& shown = p.close_up_steps;
    if (!shown.empty() && std::find(shown.begin(), shown.end(), i) == shown.end()) continue;
    if (i < results_of(p).size())
      for (const Vector3d& x : render::contact_points(results_of(p)[i].regions)) out.push_back(x);
    if (!p.trace->header.request.is_coarse()) continue;
    for (const trace::Event& e : p.trace->events_of(i))
      for (std::size_t body = 0; e.kind == EventKind::contact && body < 2; ++body) {
        const LrbRep& rep = *p.reps[body];
        const FaceId face = rep.face_of_simplex(e.simplex(static_cast<Side>(body)));
        for (const Vector3d& x : pictures::corners_of(rep, face, step_pose(p.trace->steps[i], body)))
          out.push_back(x);
      }
  }
  return out;
}

/// Returns the points that a body shows: those of all its wrappers, with regions moved if it is exploded; or
/// those of the isolated regions, with some room around them if the rest is drawn.
std::vector<Vector3d> shown_points(const LrbRep& rep, const std::vector<RegionId>& isolated, bool alone,
                                   const pictures::FrameSpec& spec) {
  std::vector<Vector3d> out;
  if (alone) {
    for (const RegionId r : isolated)
      for (const Vector3d& x : pictures::region_corners(rep, r)) out.push_back(x);
    if (!spec.ghost_rest || out.empty()) return out;
    constexpr double kAround = 0.5;  // of the regions' size, on each side
    const Vector3d centre = render::bounds(out).center();
    for (Vector3d& x : out) x = centre + (1 + kAround) * (x - centre);
    return out;
  }
  out = render::body_points(rep, Pose{});
  for (RegionId r = 0; spec.explode > 0 && r < rep.region_count(); ++r) {
    const Vector3d direction = render::exploded_way(rep, Pose{}, r, spec.explode);
    for (const Vector3d& x : pictures::region_corners(rep, r)) out.push_back(x + direction);
  }
  return out;
}

constexpr int kWidth = 240, kHeight = 180;  ///< of the pictures used to count hidden points
/// Weight of closeness to `like`, relative to the visible share of the contacts.
constexpr double kNearness = 0.15;

/// Returns the last step with contacts, or the number of steps if there is none.
std::size_t last_contact(const RecordedRun& recorded) {
  if (recorded.results == nullptr) return recorded.trace->steps.size();
  for (std::size_t i = recorded.results->size(); i-- > 0;)
    if (!(*recorded.results)[i].regions.empty()) return i;
  return recorded.trace->steps.size();
}

std::vector<Vector3d> points_at(const RecordedRun& recorded, std::size_t step) {
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < recorded.reps.size(); ++i)
    for (const Vector3d& x :
         pictures::real_corners(*recorded.reps[i], step_pose(recorded.trace->steps[step], i)))
      out.push_back(x);
  return out;
}

/// Returns the share of the points that no face hides.
double seen_share(const std::vector<Vector3d>& points, const render::Projection& projection,
                  const render::DepthImage& depths) {
  constexpr double kLift =
      2.0 / kHeight;  // a curve lies on faces: it counts as visible up to two pixels behind them
  std::size_t seen = 0;
  for (const Vector3d& p : points) seen += depths.shows(projection, p, kLift) ? 1 : 0;
  return static_cast<double>(seen) / static_cast<double>(points.size());
}

/// The vertical axis of a camera's directions, and two horizontal ones.
struct Around {
  Vector3d up, side, third;

  explicit Around(const Vector3d& upward)
      : up(upward.normalized()), side(up.unitOrthogonal()), third(up.cross(side)) {}
  Vector3d horizontal(double angle) const { return std::cos(angle) * side + std::sin(angle) * third; }
};

/// Returns directions all around, at two heights.
std::vector<Vector3d> directions(const Vector3d& up) {
  constexpr int kTurns = 16;
  const Around around(up);
  std::vector<Vector3d> out;
  for (const double height : {0.3, 0.7})
    for (int i = 0; i < kTurns; ++i)
      out.push_back(
          (around.horizontal(2 * std::numbers::pi * (i + 0.5) / kTurns) + height * around.up).normalized());
  return out;
}

/// Returns directions perpendicular to `axis`, from slightly to far above; the first is the usual one: the
/// axis points to the right. All around an almost vertical axis, and then slightly above the perpendicular.
std::vector<Vector3d> directions_across(const Vector3d& axis, const Vector3d& up) {
  constexpr double kNearlyVertical = 0.97;  // cosine: from there on, an axis has no side
  constexpr int kTurns = 16;
  constexpr double kAbove = 0.2, kOblique = 0.5;  // radians, so that boxes show two sides
  const Around around(up);
  const Vector3d along = axis.normalized();
  std::vector<Vector3d> out;
  if (std::abs(along.dot(around.up)) > kNearlyVertical) {
    for (int i = 0; i < kTurns; ++i) {
      const Vector3d d = around.horizontal(kOblique + 2 * std::numbers::pi * i / kTurns);
      out.push_back(((d - along * d.dot(along)).normalized() + kAbove * around.up).normalized());
    }
    return out;
  }
  const Vector3d side = along.cross(around.up).normalized(), above = side.cross(along);
  for (const double elevation : {0.45, 0.2, 0.32, 0.6, 0.75, 0.9})
    for (const double sign : {1.0, -1.0})
      out.push_back(sign * std::cos(elevation) * side + std::sin(elevation) * above);
  return out;
}

/// Returns the direction, of `candidates`, from which the bodies hide least of the contacts of the last step
/// with contacts; of similar ones, the one closest to `like`. Returns `like` if there is no contact.
Vector3d min_hidden_of(const RecordedRun& recorded, const std::vector<Vector3d>& candidates,
                       const Vector3d& up, const Vector3d& like) {
  const std::size_t step = last_contact(recorded);
  if (step >= recorded.trace->steps.size()) return like;
  const trace::Step& s = recorded.trace->steps[step];
  const pictures::PosedBodies bodies{*recorded.reps[0], s.pose_a, *recorded.reps[1], s.pose_b};
  const render::DrawList list = render::build_scene(bodies.in_scene()).list;
  const std::vector<Vector3d> contact = render::contact_points((*recorded.results)[step].regions);
  const std::vector<Vector3d> points = points_at(recorded, step);
  render::Rasterizer rasterizer;
  Vector3d best = like;
  double most = -1;
  for (const Vector3d& from : candidates) {
    render::FitOptions fit;
    fit.view = {from, up};
    const render::Camera camera = render::fit_camera(points, kWidth, kHeight, fit);
    const double seen = seen_share(contact, render::Projection(camera, kWidth, kHeight, render::bounds(list)),
                                   rasterizer.depths(list, camera, kWidth, kHeight)) +
                        kNearness * from.dot(like.normalized());
    if (seen > most) most = seen, best = from;
  }
  return best;
}

/// Returns true if a close-up of the contacts would show almost as much as a view of both bodies.
bool close_up_is_whole(const RecordedRun& recorded, const pictures::Look::View& close_up) {
  const std::size_t step = last_contact(recorded);
  if (step >= recorded.trace->steps.size() || recorded.reps[0]->dim() != 3) return false;
  constexpr double kCloser = 1.8;  // minimum magnification of a close-up
  pictures::Framing framing;
  framing.points = points_at(recorded, step);
  framing.contacts = contacts_of(recorded);
  pictures::Look::View whole = close_up;
  whole.camera = pictures::Look::Camera::scene;
  const Eigen::AlignedBox3d box = render::bounds(framing.points);
  const auto unit = [&](const pictures::Look::View& view) {
    const render::Camera camera = pictures::camera_for(view, framing, kWidth, kHeight, 0);
    return render::Projection(camera, kWidth, kHeight, box).unit_per_pixel(camera.target);
  };
  return unit(whole) < kCloser * unit(close_up);
}

}  // namespace

std::optional<Eigen::Vector3d> view_of_thin_body(const RecordedRun& p, const pictures::Look& look) {
  if (!look.views.empty() || p.reps.size() != 1 || p.reps[0]->dim() != 3 || p.trace->steps.empty()) return {};
  constexpr double kThin = 0.25;
  const Eigen::AlignedBox3d box = pictures::box_of(*p.reps[0], p.trace->steps[0].pose_a);
  if (box.isEmpty()) return {};
  const Eigen::Vector3d size = box.sizes(), up = pictures::Look::View{}.up;
  int thinnest = 0, vertical = 0;
  const double least = size.minCoeff(&thinnest);
  up.cwiseAbs().maxCoeff(&vertical);
  if (thinnest == vertical || !(least < kThin * size.maxCoeff())) return {};
  return pictures::broadside(box, up);
}

std::vector<Vector3d> nearest_points(const pictures::PosedBodies& bodies) {
  DistanceRequest request;
  request.relative_tolerance = 0.01;  // enough for a camera
  request.relation = false;
  if (bodies.a.dim() == 2) return {};  // a view from above has no room around two points
  const DistanceResult found = distance(bodies.a, bodies.pose_a, bodies.b, bodies.pose_b, request);
  if (!std::isfinite(found.upper) || found.upper == 0) return {};
  return {found.witness[0].point, found.witness[1].point};
}

pictures::Framing frame_sequence(const RecordedRun& p, const pictures::FrameSpec& spec) {
  const bool regions_alone = !(spec.isolate[0].empty() && spec.isolate[1].empty());
  pictures::Framing f;
  f.dim = p.reps[0]->dim();
  for (std::size_t i = 0; i < p.reps.size(); ++i) {
    const std::vector<Vector3d> body =
        extremes(shown_points(*p.reps[i], spec.isolate[i], regions_alone, spec));
    for (const trace::Step& step : p.trace->steps)
      for (const Vector3d& x : body) f.points.push_back(step_pose(step, i).apply(x));
  }
  f.contacts = contacts_of(p);
  const bool closes_up = std::any_of(spec.views.begin(), spec.views.end(), [](const auto& view) {
    return view.camera == pictures::FrameSpec::Camera::contact;
  });
  if (f.contacts.empty() && closes_up && p.reps.size() == 2 && !p.trace->steps.empty()) {
    const trace::Step& s =
        p.trace->steps[p.close_up_steps.empty() ? p.trace->steps.size() - 1 : p.close_up_steps.back()];
    f.contacts = nearest_points({*p.reps[0], s.pose_a, *p.reps[1], s.pose_b});
  }
  // The contacts of a few steps may be a point: a close-up of those still shows a part of the bodies.
  if (!p.close_up_steps.empty() && !f.contacts.empty() && f.dim == 3) {
    constexpr double kLeast = 0.1;  // of the size of everything
    const Eigen::AlignedBox3d box = render::bounds(f.contacts);
    const double missing = kLeast * render::bounds(f.points).diagonal().norm() - box.diagonal().norm();
    for (int i = 0; i < 3 && missing > 0; ++i)
      for (const double sign : {-1, 1})
        f.contacts.push_back(box.center() + sign * missing / 2 * Vector3d::Unit(i));
  }
  return f;
}

Vector3d min_hidden(const RecordedRun& recorded, const Vector3d& up, const Vector3d& like) {
  if (recorded.reps[0]->dim() != 3 || recorded.trace->steps.empty()) return like;
  const trace::Step& first = recorded.trace->steps.front();
  const Eigen::AlignedBox3d a = pictures::box_of(*recorded.reps[0], first.pose_a),
                            b = pictures::box_of(*recorded.reps[1], first.pose_b);
  const Vector3d axis = b.center() - a.center();
  constexpr double kApart = 1e-3;  // of the bodies' size: closer centres give no direction
  if (!(axis.norm() > kApart * a.merged(b).diagonal().norm()))
    return min_hidden_of(recorded, directions(up), up, like);
  const std::vector<Vector3d> candidates = directions_across(axis, up);
  return min_hidden_of(recorded, candidates, up, candidates.front());
}

std::vector<pictures::FrameSpec::View> whole_and_contact(const std::vector<pictures::FrameSpec::View>& as) {
  pictures::FrameSpec::View whole, contact;
  if (!as.empty() && as[0].camera != pictures::FrameSpec::Camera::fixed) {
    whole.from = contact.from = as[0].from;
    whole.up = contact.up = as[0].up;
    whole.orthographic = contact.orthographic = as[0].orthographic;
  }
  whole.title = "Overview with wrappers";
  contact.title = "Contact without wrappers";
  contact.camera = pictures::FrameSpec::Camera::contact;
  contact.wrapper = false;
  return {whole, contact};
}

void widen_close_ups(const RecordedRun& recorded, std::vector<pictures::Look::View>& views) {
  const bool any = std::any_of(recorded.reps.begin(), recorded.reps.end(),
                               [](const LrbRep* rep) { return rep->region_count() > 0; }) &&
                   std::any_of(views.begin(), views.end(), [](const auto& view) { return view.wrapper; });
  for (pictures::Look::View& view : views) {
    for (const char* what : {" with wrappers", " without wrappers"})
      if (!any && view.title.ends_with(what)) view.title.resize(view.title.rfind(" with"));
    if (view.camera != pictures::Look::Camera::contact || !close_up_is_whole(recorded, view)) continue;
    view.camera = pictures::Look::Camera::scene;
    if (!view.wrapper) view.title = any ? "Without wrappers" : "Overview";
  }
}

}  // namespace lrb::frames
