#include "scenarios/run/separation_picture.hpp"

#include <vector>

#include "engine/lrb/wrapper.hpp"
#include "render/montage.hpp"
#include "render/overlay.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "render/scene.hpp"

namespace lrb::run {
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
