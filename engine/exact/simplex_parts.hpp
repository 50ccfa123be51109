#pragma once
/// Intersection of a segment with a plane or a line, rounded to double. Private to engine/exact.

#include <cstdint>

#include <Eigen/Core>

#include "engine/exact/plane_side.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::exact {

/// Returns the intersection of the segment p, q with the plane of triangle t. p must not be in the plane, nor
/// q on p's side of it. hp, hq: PlaneSide::determinant() of that plane at p and q. Each coordinate is within
/// 1e-13 |q - p| plus one rounding of the exact point.
Eigen::Vector3d cut_by_plane(const double* p, const Approximate& hp, const double* q, const Approximate& hq,
                             const double* const t[3]);

/// Returns the intersection of the segment p, q with the line through a and b, in the projection to
/// coordinates x and y. Fills the first `dim` coordinates of the result and sets the others to 0. p must not
/// be on the line, nor q strictly on p's side of it. Same accuracy.
Eigen::Vector3d cut_by_line(const double* p, const double* q, const double* a, const double* b, int x, int y,
                            int dim);

// Building blocks of pair contacts.

inline Feature corner(int i) {
  return {0, static_cast<std::uint8_t>(i)};
}
/// Returns the edge of a triangle between its corners i and j.
inline Feature edge_between(int i, int j) {
  return {1, static_cast<std::uint8_t>((i + 1) % 3 == j ? i : j)};
}

inline Eigen::Vector3d as_vector(const double* p) {
  return {p[0], p[1], p[2]};
}

inline void append(PairContact& r, const ContactCorner& c) {
  r.corners[r.corner_count++] = c;
}

/// Intersects two coplanar triangles with area: a polygon, a segment, a point or nothing.
PairContact contact_in_plane(const double* const a[3], const double* const b[3]);

/// Intersects two triangles, at least one of which has no area: a segment, a point or nothing.
PairContact contact_of_degenerate(const double* const a[3], const double* const b[3]);

// Coplanar triangles, and triangles with collinear corners.

/// The convex hull of a triangle's corners, exactly: the triangle, a segment or a point.
struct Hull {
  const double* corner[3];  ///< the first dim + 1; of a segment, the lexicographic extremes of the three
  int dim;
};

Hull hull_of(const double* const t[3]);

/// A pair of coordinates such that the projections of three points are collinear only if the points are.
struct Axes {
  int x, y;
  int turn;  ///< orientation of the projected points, -1 or +1; 0: collinear
};

/// Returns axes for three points; turn = 0 if they are collinear.
Axes axes_for(const double* a, const double* b, const double* c);

/// Returns true if two hulls intersect. They may have any dimensions, but two triangles must be coplanar.
bool hulls_meet(const Hull& a, const Hull& b);

}  // namespace lrb::exact
