#pragma once

#include <span>

#include <Eigen/Core>

namespace lrb::bodies {

/// Returns the volume of the convex hull of points; 0 if all lie in one plane. The hull is exact
/// (construct::convex_hull), the volume rounded.
double hull_volume(std::span<const Eigen::Vector3d> points);

/// Returns the area of the convex hull of points in the plane z = 0.
double hull_area(std::span<const Eigen::Vector3d> points);

}  // namespace lrb::bodies
