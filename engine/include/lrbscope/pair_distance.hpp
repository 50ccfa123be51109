#pragma once
/// The distance of two triangles or segments, computed in integers: slow (tens of microseconds) and exact.
/// For pairs whose interval in doubles is too wide, and for comparison with a given distance.
///
/// Both functions take two disjoint simplices: their corners in the world frame, as pointers to their
/// coordinates, which must be finite: `a` and `b` have n each, in any order. n = 3: triangles in 3D. n = 2:
/// segments in the plane z = 0, of which only x and y are read. Collinear or coincident corners count as the
/// segment or point that they span. Distances are in the unit of the coordinates. Nothing is checked or
/// thrown.

#include <Eigen/Core>

#include <lrbscope/contact.hpp>

namespace lrb::exact {

/// The closest points of two disjoint simplices.
struct PairDistance {
  /// Bounds of the distance: equal if it is a double, else adjacent doubles. An upper bound beyond the range
  /// of doubles is infinite.
  double lower = 0, upper = 0;
  /// World frame. Each coordinate is within three roundings of the exact point, relative to the largest
  /// corner coordinate.
  Eigen::Vector3d point[2];
  Feature on[2];  ///< exact: features that contain the points on the simplices of A and of B
};

/// Returns the distance of two simplices.
PairDistance distance_of_simplices(const double* const* a, const double* const* b, int n);

/// Returns the sign (-1, 0, 1) of the distance minus `distance`, which must be finite and at least 0.
int compare_distance(const double* const* a, const double* const* b, int n, double distance);

}  // namespace lrb::exact
