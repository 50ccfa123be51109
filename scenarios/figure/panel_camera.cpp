#include "scenarios/figure/panel_camera.hpp"

#include <cmath>

namespace lrb::figure {

Eigen::AlignedBox2d seen_box(const render::DrawList& list, const render::Camera& camera) {
  const Eigen::AlignedBox2d square(Eigen::Vector2d(0, 0), Eigen::Vector2d(kViewSide, kViewSide));
  const render::Projection projection(camera, kViewSide, kViewSide, render::bounds(list));
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& x : render::extent_points(list)) {
    const auto at = projection.to_pixel(x);
    if (!at) return square;
    box.extend(*at);
  }
  box = box.intersection(square);
  const bool empty = box.isEmpty() || !(box.sizes().minCoeff() > 0);
  return empty ? square : box;
}

render::Camera middle_part(const render::Camera& camera, double height) {
  render::Camera out = camera;
  out.half_height *= height / kViewSide;
  out.fov_y = 2 * std::atan(std::tan(0.5 * camera.fov_y) * height / kViewSide);
  return out;
}

}  // namespace lrb::figure
