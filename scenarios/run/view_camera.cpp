#include "scenarios/run/view_camera.hpp"

#include <cmath>
#include <numbers>

namespace lrb::run {

render::Camera camera_for(const render::FrameSpec::View& view, const Framing& framing, double width,
                          double height, double progress) {
  using Kind = render::FrameSpec::Camera;
  const bool close = view.camera == Kind::contact && !framing.contacts.empty();
  render::Camera camera;
  if (view.camera == Kind::fixed) {
    camera.eye = view.eye;
    camera.target = view.target;
    camera.up = view.up;
    camera.orthographic = view.orthographic;
    camera.half_height = (view.eye - view.target).norm() * std::tan(camera.fov_y / 2);
  } else if (framing.dim == 2) {
    camera = render::fit_top(close ? framing.contacts : framing.points, width, height);
  } else {
    render::FitOptions options;
    options.view = {view.from, view.up};
    options.orthographic = view.orthographic;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : framing.points) box.extend(p);
    constexpr double kRoomAround = 1.6;  // in sizes of the contacts
    camera = close ? render::fit_contact(framing.contacts, box, width, height, options, kRoomAround)
                   : render::fit_camera(framing.points, width, height, options);
    if (view.camera == Kind::orbit)
      camera = render::orbit(camera, view.turn_degrees * progress * std::numbers::pi / 180);
  }
  if (view.look_at) {
    camera.eye += *view.look_at - camera.target;
    camera.target = *view.look_at;
  }
  camera.half_height /= view.zoom;
  if (!camera.orthographic) camera.eye = camera.target + (camera.eye - camera.target) / view.zoom;
  return camera;
}

Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(pose.apply(rep.vertices()[v]));
  return box;
}

Eigen::AlignedBox3d box_with_lids(const LrbRep& rep, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : rep.vertices()) box.extend(pose.apply(v));
  return box;
}

Eigen::Vector3d broadside(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& up) {
  int vertical = 0;
  up.cwiseAbs().maxCoeff(&vertical);
  const int first = (vertical + 1) % 3, second = (vertical + 2) % 3;
  const Eigen::Vector3d size = box.sizes();
  constexpr double kClearly = 1.15;
  Eigen::Vector3d out = 0.42 * up.normalized();
  // Two level sides of about one length are both seen; else most of the longer one.
  out[first] = size[first] > kClearly * size[second]   ? 0.38
               : size[second] > kClearly * size[first] ? 0.84
                                                       : 0.62;
  out[second] = size[first] > kClearly * size[second]   ? -0.84
                : size[second] > kClearly * size[first] ? -0.38
                                                        : -0.68;
  return out;
}

}  // namespace lrb::run
