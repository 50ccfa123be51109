#include "scenarios/frames/chosen_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>

namespace lrb::run {
namespace {

using Eigen::Vector3d;

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
  const trace::Step& s = recorded.trace->steps[step];
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < recorded.reps.size(); ++i) {
    const LrbRep& rep = *recorded.reps[i];
    const Pose& pose = i == 0 ? s.pose_a : s.pose_b;
    for (FaceId f = 0; f < rep.real_face_count(); ++f)
      for (const VertexId v : rep.face(f)) out.push_back(pose.apply(rep.vertices()[v]));
  }
  return out;
}

/// Returns the share of the points that no face hides.
double seen_share(const std::vector<Vector3d>& points, const render::Projection& projection,
                  const render::DepthImage& depths) {
  constexpr double kLift =
      2.0 / kHeight;  // a curve lies on faces: it counts as visible up to two pixels behind them
  std::size_t seen = 0;
  for (const Vector3d& p : points) {
    const Vector3d at = projection.to_screen(projection.to_eye(p));
    const int x = std::clamp(static_cast<int>(at.x()), 0, kWidth - 1);
    const int y = std::clamp(static_cast<int>(kHeight - at.y()), 0, kHeight - 1);
    seen += projection.nearer(at.z(), kLift) <= depths.at(x, y) ? 1 : 0;
  }
  return static_cast<double>(seen) / static_cast<double>(points.size());
}

/// Returns directions all around, at two heights.
std::vector<Vector3d> directions(const Vector3d& up) {
  constexpr int kTurns = 16;
  const Vector3d u = up.normalized(), side = u.unitOrthogonal(), third = u.cross(side);
  std::vector<Vector3d> out;
  for (const double height : {0.3, 0.7})
    for (int i = 0; i < kTurns; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kTurns;
      out.push_back((std::cos(angle) * side + std::sin(angle) * third + height * u).normalized());
    }
  return out;
}

/// Returns true if a close-up of the contacts would show almost as much as a view of both bodies.
bool close_up_is_whole(const RecordedRun& recorded, const render::FrameSpec::View& close_up) {
  const std::size_t step = last_contact(recorded);
  if (step >= recorded.trace->steps.size() || recorded.reps[0]->dim() != 3) return false;
  constexpr double kCloser = 1.8;  // minimum magnification of a close-up
  Framing framing;
  framing.points = points_at(recorded, step);
  for (const CollideResult& result : *recorded.results)
    for (const Vector3d& p : render::contact_points(result.regions)) framing.contacts.push_back(p);
  render::FrameSpec::View whole = close_up;
  whole.camera = render::FrameSpec::Camera::scene;
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : framing.points) box.extend(p);
  const auto unit = [&](const render::FrameSpec::View& view) {
    const render::Camera camera = camera_for(view, framing, kWidth, kHeight, 0);
    return render::Projection(camera, kWidth, kHeight, box).unit_per_pixel(camera.target);
  };
  return unit(whole) < kCloser * unit(close_up);
}

}  // namespace

Vector3d least_hidden(const RecordedRun& recorded, const Vector3d& up, const Vector3d& like) {
  const std::size_t step = last_contact(recorded);
  if (step >= recorded.trace->steps.size() || recorded.reps[0]->dim() != 3) return like;
  const trace::Step& s = recorded.trace->steps[step];
  std::vector<render::SceneBody> bodies(2);
  for (std::size_t i = 0; i < 2; ++i) {
    bodies[i].rep = recorded.reps[i];
    bodies[i].pose = i == 0 ? s.pose_a : s.pose_b;
  }
  const render::DrawList list = render::build_scene(bodies).list;
  const std::vector<Vector3d> contact = render::contact_points((*recorded.results)[step].regions);
  const std::vector<Vector3d> points = points_at(recorded, step);
  render::Rasterizer rasterizer;
  Vector3d best = like;
  double most = -1;
  for (const Vector3d& from : directions(up)) {
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

void widen_close_ups(const RecordedRun& recorded, std::vector<render::FrameSpec::View>& views) {
  for (render::FrameSpec::View& view : views) {
    if (view.camera != render::FrameSpec::Camera::contact || !close_up_is_whole(recorded, view)) continue;
    view.camera = render::FrameSpec::Camera::scene;
    if (!view.wrapper) view.title = "Without wrappers";
  }
}

}  // namespace lrb::run
