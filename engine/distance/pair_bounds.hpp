#pragma once
/// The distance of two simplices in double, as a proven interval.

#include <Eigen/Core>

#include <lrbscope/contact.hpp>

namespace lrb {

struct PairBounds {
  /// Hold the distance. Not finite, or 0, where doubles do not suffice: then exact arithmetic has to.
  double lower = 0, upper = 0;
  Eigen::Vector3d
      point[2];  ///< the points that gave `upper`, on the simplex of A and on that of B, but for rounding
  exact::Feature on[2];  ///< where they lie
  Eigen::Vector3d direction{0, 0,
                            0};  ///< across the slab whose width is `lower`, of any length; 0: there is none
};

/// Bounds the distance of two triangles (n = 3) in space, or of two segments (n = 2) in the plane z = 0.
/// Intersecting simplices get a lower bound of 0, and an upper bound between features, which may exceed 0.
PairBounds bound_distance(const double* const* a, const double* const* b, int n);

/// Returns the width of the slab between two simplices along a direction of any length, a lower bound on
/// their distance. Returns 0 if it is less than `least` by more than rounding: then bound_distance() may
/// give more.
double distance_along(const Eigen::Vector3d& direction, double least, const double* const* a,
                      const double* const* b, int n);

}  // namespace lrb
