#pragma once
/// The distance of two simplices, decided in integers: slow (tens of microseconds), and always right. For
/// pairs that doubles leave too wide an interval for, and as a comparison with a given distance.

#include <Eigen/Core>

#include <lrbscope/contact.hpp>

namespace lrb::exact {

/// The nearest points of two simplices that do not meet.
struct PairDistance {
  /// Doubles that hold the distance: equal if it is one, else neighbours. An upper end beyond the range of
  /// doubles is infinite.
  double lower = 0, upper = 0;
  /// World frame; each coordinate within three roundings of the exact point's, relative to the corners'
  /// largest.
  Eigen::Vector3d point[2];
  Feature on[2];  ///< exact: where the points lie on the simplex of A and on that of B
};

/// Returns the distance of two triangles (n = 3) in space, or of two segments (n = 2) in the plane z = 0, of
/// which only x and y are read. They must not meet. Corners that are collinear or equal count as the segment
/// or point that they span.
PairDistance distance_of_simplices(const double* const* a, const double* const* b, int n);

/// Returns the sign (-1, 0, 1) of their distance minus `distance`, which must be finite and at least 0.
int compare_distance(const double* const* a, const double* const* b, int n, double distance);

}  // namespace lrb::exact
