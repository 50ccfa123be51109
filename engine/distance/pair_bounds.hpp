#pragma once
/// The distance of two simplices in double, as a proven interval.

#include <Eigen/Core>

#include <lrbscope/contact.hpp>

namespace lrb {

struct PairBounds {
  /// Bounds of the distance. Not finite, or 0, if doubles do not suffice and exact arithmetic is needed.
  double lower = 0, upper = 0;
  Eigen::Vector3d point[2];  ///< the closest points, on A's simplex and on B's up to rounding
  exact::Feature on[2];      ///< features that contain the points
  Eigen::Vector3d direction{0, 0,
                            0};  ///< normal of the slab whose width is `lower`, of any length; 0: no slab
};

/// Bounds the distance of two triangles (n = 3) in 3D, or of two segments (n = 2) in the plane z = 0.
/// Intersecting simplices get a lower bound of 0, and an upper bound between features, which may exceed 0.
PairBounds bound_distance(const double* const* a, const double* const* b, int n);

/// Returns the width of the slab between two simplices along a direction of any length, a lower bound on
/// their distance, or 0 if it is less than `least` by more than rounding: bound_distance() may then yield
/// more.
double distance_along(const Eigen::Vector3d& direction, double least, const double* const* a,
                      const double* const* b, int n);

}  // namespace lrb
