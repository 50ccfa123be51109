#pragma once
/// What hull_oracle.hpp says of simplices with corners of doubles, compiled once for all tests: Boost's
/// integers take long to compile.

#include <cstddef>
#include <vector>

namespace lrb::oracle {

/// Returns how triangles (n = 3) in space or segments (n = 2) in the plane meet: 0 disjoint, 1 touch, 2
/// cross.
int meet_of_simplices(const double* const* a, const double* const* b, std::size_t n);

/// Returns the sign of the determinant of the differences to the first point: n + 1 points in n dimensions.
int orientation(const std::vector<const double*>& points);

/// Returns the dimension of the affine hull of points with `dim` coordinates.
int affine_dimension_of(const std::vector<const double*>& points, std::size_t dim);

}  // namespace lrb::oracle
