#pragma once
/// The point in which a plane or a line cuts a segment, rounded to double. Private to engine/exact.

#include <Eigen/Core>

namespace lrb::exact {

/// Returns the point in which the segment p, q meets the plane of triangle t. p must not lie in the plane,
/// nor q on p's side of it. Each coordinate is within 1e-13 |q - p| + one rounding of the exact point's.
Eigen::Vector3d cut_by_plane(const double* p, const double* q, const double* const t[3]);

/// Returns the point in which the segment p, q meets the line through a and b, all seen in coordinates x and
/// y. Fills the first `dim` coordinates of the result and sets the others to 0. p must not lie on the line,
/// nor q strictly on p's side of it. Same accuracy.
Eigen::Vector3d cut_by_line(const double* p, const double* q, const double* a, const double* b, int x, int y,
                            int dim);

}  // namespace lrb::exact
