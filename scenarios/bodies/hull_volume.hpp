#pragma once

#include <span>

#include <Eigen/Core>

namespace lrb::bodies {

/// Volume of the convex hull of points; 0 if all lie in one plane. Quickhull (Barber, Dobkin, Huhdanpaa 1996)
/// with exact signs, so that it ends on any input; the volume itself is rounded.
double hull_volume(std::span<const Eigen::Vector3d> points);

/// Area of the convex hull of points in the plane z = 0.
double hull_area(std::span<const Eigen::Vector3d> points);

}  // namespace lrb::bodies
