// Intersection tests for convex hulls of up to three points: triangles, segments and points. Cases:
// - coplanar sets: the separating axis theorem in 2D, where only edge lines can separate;
// - a triangle and a segment that crosses its plane: signed volumes (Ericson 2005, 5.3.4);
// - sets on one line: overlap of intervals.
// All decisions are exact signs of determinants.

#include "engine/exact/degenerate.hpp"

#include <algorithm>
#include <cmath>

#include "engine/exact/exact_sign.hpp"
#include "engine/exact/orient_axes.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::exact {
namespace {

bool lexicographic_less(const double* a, const double* b) {
  return std::lexicographical_compare(a, a + 3, b, b + 3);
}

bool intervals_meet(double a0, double a1, double b0, double b1) {
  return std::max(std::min(a0, a1), std::min(b0, b1)) <= std::min(std::max(a0, a1), std::max(b0, b1));
}

/// Returns true if two segments on one line (either may be a point) intersect. They do if their bounding
/// boxes do.
bool on_line_meet(const double* a0, const double* a1, const double* b0, const double* b1) {
  return intervals_meet(a0[0], a1[0], b0[0], b1[0]) && intervals_meet(a0[1], a1[1], b0[1], b1[1]) &&
         intervals_meet(a0[2], a1[2], b0[2], b1[2]);
}

/// Returns true if all of hull h lies strictly on side `side` of the line p, q.
bool strictly_beside(const double* p, const double* q, const Hull& h, int side, const Axes& axes) {
  for (int i = 0; i <= h.dim; ++i) {
    if (orient_axes(p, q, h.corner[i], axes.x, axes.y) != side) return false;
  }
  return true;
}

/// Returns true if the line of an edge of `a` has a on one side and b strictly on the other. The line of a
/// segment may separate with b on either side. Everything lies in one plane, which projects to `axes` one to
/// one.
bool edge_separates(const Hull& a, const Hull& b, const Axes& axes) {
  // A point has no edge. The other set's edges are tested by the caller.
  if (a.dim == 0) return false;
  const double* const* p = a.corner;
  if (a.dim == 1) return strictly_beside(p[0], p[1], b, 1, axes) || strictly_beside(p[0], p[1], b, -1, axes);
  // The sign of a triangle's outer sides depends on its orientation in the projection.
  const int outside = -orient_axes(p[0], p[1], p[2], axes.x, axes.y);
  return strictly_beside(p[0], p[1], b, outside, axes) || strictly_beside(p[1], p[2], b, outside, axes) ||
         strictly_beside(p[2], p[0], b, outside, axes);
}

/// Returns true if two coplanar convex sets, which together are not on one line, intersect. They are disjoint
/// exactly if the line of an edge separates them, because the sides of their Minkowski difference, a polygon
/// with inner points, are parallel to their edges.
bool coplanar_meet(const Hull& a, const Hull& b, const Axes& axes) {
  return !edge_separates(a, b, axes) && !edge_separates(b, a, axes);
}

bool triangle_meets(const Hull& t, const Hull& h) {
  const double* const* p = t.corner;
  // A point counts as a segment whose ends coincide.
  const PlaneSide plane(p[0], p[1], p[2]);
  const int start = plane.side(h.corner[0]);
  const int end = h.dim == 0 ? start : plane.side(h.corner[1]);
  // Both ends are strictly on one side: no intersection. Both in the plane: a test in 2D.
  if (start * end > 0) return false;
  if (start == 0 && end == 0) return coplanar_meet(t, h, axes_for(p[0], p[1], p[2]));
  // The segment intersects the plane in one point. That point is in the triangle if the segment's line passes
  // all three edges on the same side. A zero means that it intersects an edge, and is compatible with both
  // sides.
  int seen = 0;
  for (int i = 0; i < 3; ++i) {
    const int s = orient3d(h.corner[0], h.corner[1], p[i], p[(i + 1) % 3]);
    if (s * seen < 0) return false;
    if (s != 0) seen = s;
  }
  return true;
}

bool segments_meet(const Hull& a, const Hull& b) {
  const double *a0 = a.corner[0], *a1 = a.corner[1], *b0 = b.corner[0], *b1 = b.corner[1];
  // Find a plane that contains both segments. If no three of the four points span one, all are on one line.
  Axes axes = axes_for(a0, a1, b0);
  if (axes.turn == 0) axes = axes_for(a0, a1, b1);
  if (axes.turn == 0) return on_line_meet(a0, a1, b0, b1);
  // Skew lines have no point in common.
  if (orient3d(a0, a1, b0, b1) != 0) return false;
  return coplanar_meet(a, b, axes);
}

}  // namespace

Axes axes_for(const double* a, const double* b, const double* c) {
  // Try the widest projection first, as far as doubles can tell: its sign is the least likely to need exact
  // arithmetic.
  const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
  const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
  const double n[3] = {std::fabs(uy * vz - uz * vy), std::fabs(uz * vx - ux * vz),
                       std::fabs(ux * vy - uy * vx)};
  int dropped = n[1] > n[0] ? 1 : 0;
  if (n[2] > n[dropped]) dropped = 2;
  // The exact sign decides. If all three projections have no area, the points are collinear.
  for (int tried = 0; tried < 3; ++tried, dropped = (dropped + 1) % 3) {
    const int x = (dropped + 1) % 3, y = (dropped + 2) % 3;
    const int turn = orient_axes(a, b, c, x, y);
    if (turn != 0) return {x, y, turn};
  }
  return {0, 1, 0};
}

Hull hull_of(const double* const t[3]) {
  if (axes_for(t[0], t[1], t[2]).turn != 0) return {{t[0], t[1], t[2]}, 2};
  // On one line, the lexicographic extremes are the ends of the segment that the corners span.
  const auto [least, most] = std::minmax({t[0], t[1], t[2]}, lexicographic_less);
  return {{least, most, most}, same_point(least, most) ? 0 : 1};
}

bool hulls_meet(const Hull& a, const Hull& b) {
  // Order by dimension, so that each case is handled once.
  if (a.dim < b.dim) return hulls_meet(b, a);
  if (a.dim == 2 && b.dim < 2) return triangle_meets(a, b);
  if (a.dim == 2) return coplanar_meet(a, b, axes_for(a.corner[0], a.corner[1], a.corner[2]));
  if (a.dim == 1 && b.dim == 1) return segments_meet(a, b);
  // A point can only intersect a segment on the segment's line.
  if (a.dim == 1 && !collinear3d(a.corner[0], a.corner[1], b.corner[0])) return false;
  return on_line_meet(a.corner[0], a.corner[a.dim], b.corner[0], b.corner[b.dim]);
}

}  // namespace lrb::exact
