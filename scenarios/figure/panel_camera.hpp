#pragma once
/// The camera of a figure's panels: fitted to everything once, in a square of its own units, of which panels
/// show parts.

#include <Eigen/Geometry>

#include "render/camera.hpp"
#include "render/draw_list.hpp"

namespace lrb::figure {

/// The side of the square that cameras are fitted to, in units of the view.
inline constexpr double kViewSide = 1000;

/// Returns the box of what is drawn of a list, inside the square; the whole square if something reaches
/// behind the camera, or nothing is seen.
Eigen::AlignedBox2d seen_box(const render::DrawList& list, const render::Camera& camera);

/// Returns the camera that shows the middle of the square, `height` units of it, at the same scale in a
/// picture of that height.
render::Camera middle_part(const render::Camera& camera, double height);

}  // namespace lrb::figure
