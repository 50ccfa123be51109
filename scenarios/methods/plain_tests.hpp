#pragma once
/// Tests of two simplices in plain double with an epsilon, as textbooks give them. The exact ones are
/// compared with them.

#include <Eigen/Core>

namespace lrb::methods {

/// Distances from a plane, areas and parameters below this count as 0. The widely copied code of the triangle
/// test by intervals uses this value, meant for coordinates of about 1. It is absolute on purpose: this is
/// what the comparison is about.
inline constexpr double kUsualEpsilon = 1e-6;

/// Returns true if two triangles meet. Compares the intervals in which they cut the line common to their
/// planes (T. Moeller, "A Fast Triangle-Triangle Intersection Test", Journal of Graphics Tools 2(2), 1997);
/// coplanar ones by their edges in the plane.
bool plain_triangles_meet(const Eigen::Vector3d a[3], const Eigen::Vector3d b[3]);

/// Returns true if two segments of the plane z = 0 meet, by the sides that their ends lie on.
bool plain_segments_meet(const Eigen::Vector3d a[2], const Eigen::Vector3d b[2]);

}  // namespace lrb::methods
