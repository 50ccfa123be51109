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

/// Returns true if two segments on one line (either may be a point) meet: they do if their boxes do.
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
  if (a.dim == 0) return false;
  const double* const* p = a.corner;
  if (a.dim == 1) return strictly_beside(p[0], p[1], b, 1, axes) || strictly_beside(p[0], p[1], b, -1, axes);
  const int outside = -orient_axes(p[0], p[1], p[2], axes.x, axes.y);
  return strictly_beside(p[0], p[1], b, outside, axes) || strictly_beside(p[1], p[2], b, outside, axes) ||
         strictly_beside(p[2], p[0], b, outside, axes);
}

/// Returns true if two convex sets in one plane, which together are not on one line, meet. They are disjoint
/// exactly if the line of an edge separates them, because the sides of their Minkowski difference, a polygon
/// with inner points, are parallel to their edges.
bool coplanar_meet(const Hull& a, const Hull& b, const Axes& axes) {
  return !edge_separates(a, b, axes) && !edge_separates(b, a, axes);
}

bool triangle_meets(const Hull& t, const Hull& h) {
  const double* const* p = t.corner;
  const PlaneSide plane(p[0], p[1], p[2]);
  const int start = plane.side(h.corner[0]);
  const int end = h.dim == 0 ? start : plane.side(h.corner[1]);
  if (start * end > 0) return false;
  if (start == 0 && end == 0) return coplanar_meet(t, h, axes_for(p[0], p[1], p[2]));
  // The segment meets the plane in one point: it lies in the triangle if the segment's line passes all edges
  // on the same side.
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
  Axes axes = axes_for(a0, a1, b0);
  if (axes.turn == 0) axes = axes_for(a0, a1, b1);
  if (axes.turn == 0) return on_line_meet(a0, a1, b0, b1);
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
  for (int tried = 0; tried < 3; ++tried, dropped = (dropped + 1) % 3) {
    const int x = (dropped + 1) % 3, y = (dropped + 2) % 3;
    const int turn = orient_axes(a, b, c, x, y);
    if (turn != 0) return {x, y, turn};
  }
  return {0, 1, 0};
}

Hull hull_of(const double* const t[3]) {
  if (axes_for(t[0], t[1], t[2]).turn != 0) return {{t[0], t[1], t[2]}, 2};
  const auto [least, most] = std::minmax({t[0], t[1], t[2]}, lexicographic_less);
  return {{least, most, most}, same_point(least, most) ? 0 : 1};
}

bool hulls_meet(const Hull& a, const Hull& b) {
  if (a.dim < b.dim) return hulls_meet(b, a);
  if (a.dim == 2 && b.dim < 2) return triangle_meets(a, b);
  if (a.dim == 2) return coplanar_meet(a, b, axes_for(a.corner[0], a.corner[1], a.corner[2]));
  if (a.dim == 1 && b.dim == 1) return segments_meet(a, b);
  if (a.dim == 1 && !collinear3d(a.corner[0], a.corner[1], b.corner[0])) return false;
  return on_line_meet(a.corner[0], a.corner[a.dim], b.corner[0], b.corner[b.dim]);
}

}  // namespace lrb::exact
