#pragma once
/// Where a segment is cut by a plane or a line, rounded to double. Private to engine/exact.

#include <Eigen/Core>

namespace lrb::exact {

/// The point of segment p, q (q not in the plane's side of p; p not in the plane) in the plane of triangle t.
/// Each coordinate is within 1e-13 |q - p| + one rounding of the exact point's.
Eigen::Vector3d cut_by_plane(const double* p, const double* q, const double* const t[3]);

/// The point of segment p, q on the line through a, b as seen in coordinates x and y; `dim` coordinates are
/// used and the others of the result are 0. p and q do not lie strictly on one side; p is not on the line.
/// Same accuracy.
Eigen::Vector3d cut_by_line(const double* p, const double* q, const double* a, const double* b, int x, int y,
                            int dim);

}  // namespace lrb::exact
