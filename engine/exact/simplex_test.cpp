// Exact intersection tests of two triangles and of two segments, by orientation signs alone (Guigue and
// Devillers 2003; interval overlap after Moeller 1997). For triangles:
// 1. Shared corners (equal coordinates) are in both planes: no sign is computed for them.
// 2. Sides of each triangle's corners on the other's plane. All strictly on one side: disjoint.
// 3. Coplanar triangles and triangles without area: hulls_meet().
// 4. Otherwise compare the ends of the two spans on the line in which the planes cross.

#include <algorithm>
#include <cmath>

#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::exact {

// Intersection tests for convex hulls of up to three points: triangles, segments and points. Cases:
// - coplanar sets: the separating axis theorem in 2D, where only edge lines can separate;
// - a triangle and a segment that crosses its plane: signed volumes (Ericson 2005, 5.3.4);
// - collinear sets: overlap of intervals.
// All decisions are exact signs of determinants.

namespace {

bool lexicographic_less(const double* a, const double* b) {
  return std::lexicographical_compare(a, a + 3, b, b + 3);
}

bool intervals_meet(double a0, double a1, double b0, double b1) {
  return std::max(std::min(a0, a1), std::min(b0, b1)) <= std::min(std::max(a0, a1), std::max(b0, b1));
}

/// Returns true if two collinear segments (either may be a point) intersect: if and only if their bounding
/// boxes do.
bool on_line_meet(const double* a0, const double* a1, const double* b0, const double* b1) {
  return intervals_meet(a0[0], a1[0], b0[0], b1[0]) && intervals_meet(a0[1], a1[1], b0[1], b1[1]) &&
         intervals_meet(a0[2], a1[2], b0[2], b1[2]);
}

/// Returns true if the entire hull h is strictly on side `side` of the line p, q.
bool strictly_beside(const double* p, const double* q, const Hull& h, int side, const Axes& axes) {
  for (int i = 0; i <= h.dim; ++i) {
    if (orient_axes(p, q, h.corner[i], axes.x, axes.y) != side) return false;
  }
  return true;
}

/// Returns true if the line of an edge of `a` has a on one side and b strictly on the other. The line of a
/// segment separates with b on either side. Everything is in one plane, which projects to `axes` injectively.
bool edge_separates(const Hull& a, const Hull& b, const Axes& axes) {
  // A point has no edge. The other set's edges are tested by the caller.
  if (a.dim == 0) return false;
  const double* const* p = a.corner;
  if (a.dim == 1) return strictly_beside(p[0], p[1], b, 1, axes) || strictly_beside(p[0], p[1], b, -1, axes);
  // The outer side of a triangle's edges depends on its orientation in the projection.
  const int outside = -orient_axes(p[0], p[1], p[2], axes.x, axes.y);
  return strictly_beside(p[0], p[1], b, outside, axes) || strictly_beside(p[1], p[2], b, outside, axes) ||
         strictly_beside(p[2], p[0], b, outside, axes);
}

/// Returns true if two coplanar convex sets intersect; together they must not be collinear. They are disjoint
/// if and only if the line of an edge separates them, because each side of their Minkowski difference, a
/// polygon with interior, is parallel to one of their edges.
bool coplanar_meet(const Hull& a, const Hull& b, const Axes& axes) {
  return !edge_separates(a, b, axes) && !edge_separates(b, a, axes);
}

bool triangle_meets(const Hull& t, const Hull& h) {
  const double* const* p = t.corner;
  // A point counts as a segment whose ends coincide.
  const PlaneSide plane(p[0], p[1], p[2]);
  const int start = plane.side(h.corner[0]);
  const int end = h.dim == 0 ? start : plane.side(h.corner[1]);
  // Both ends are strictly on one side: disjoint. Both in the plane: a test in 2D.
  if (start * end > 0) return false;
  if (start == 0 && end == 0) return coplanar_meet(t, h, axes_for(p[0], p[1], p[2]));
  // The segment intersects the plane in one point. It is in the triangle if the segment's line passes all
  // three edges on the same side. A zero means that it intersects an edge, and is compatible with both sides.
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
  // Find a plane that contains both segments. If no three of the four points span one, all are collinear.
  Axes axes = axes_for(a0, a1, b0);
  if (axes.turn == 0) axes = axes_for(a0, a1, b1);
  if (axes.turn == 0) return on_line_meet(a0, a1, b0, b1);
  // Skew lines are disjoint.
  if (orient3d(a0, a1, b0, b1) != 0) return false;
  return coplanar_meet(a, b, axes);
}

}  // namespace

Axes axes_for(const double* a, const double* b, const double* c) {
  // Try the largest projection first, estimated in doubles: its sign is the least likely to need exact
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
  // Collinear: the lexicographic extremes are the ends of the segment that the corners span.
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

namespace {

Meet meet_on_line(const CrossingPlanes& c, bool both_mixed) {
  // Positive: b's high end is above a's low end. Negative: the spans are disjoint.
  const int above = c.order(c.on_a.low, c.on_b.high);
  if (above < 0) return Meet::disjoint;
  // The same for a's high end and b's low end.
  const int below = -c.order(c.on_a.high, c.on_b.low);
  if (below < 0) return Meet::disjoint;
  // The relative interiors intersect L in open intervals, which are empty unless the other plane divides the
  // triangle.
  return both_mixed && above > 0 && below > 0 ? Meet::cross : Meet::touch;
}

Meet meet_degenerate(const double* const a[3], const double* const b[3]) {
  return hulls_meet(hull_of(a), hull_of(b)) ? Meet::touch : Meet::disjoint;
}

/// The common corners of two triangles: corner k of the first equals corner with[k] of the second; -1: none.
struct Shared {
  int with[3] = {-1, -1, -1};
  int count = 0;

  Shared(const double* const a[3], const double* const b[3]) {
    // `taken` matches each corner of b once, even if a triangle repeats a corner.
    bool taken[3] = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3 && with[i] < 0; ++j) {
        if (a[i][0] != b[j][0] || taken[j] || !same_point(a[i], b[j])) continue;
        with[i] = j;
        taken[j] = true;
        ++count;
      }
  }
};

/// Returns the sides of the corners. Corners that define the plane (`own`) are on it and need no test.
Sides sides_of(const PlaneSide& plane, const double* const t[3], const bool own[3]) {
  Sides sides{};
  for (int i = 0; i < 3; ++i) sides.s[i] = own[i] ? 0 : plane.side(t[i]);
  return sides;
}

Meet meet_by_planes(const double* const a[3], const bool shared_a[3], const double* const b[3],
                    const bool shared_b[3]) {
  const PlaneSide plane_a(a[0], a[1], a[2]);
  // All zero: b is coplanar with a, or a has no area and its plane gives no sign.
  const Sides b_sides = sides_of(plane_a, b, shared_b);
  if (b_sides.all_strictly_same()) return Meet::disjoint;
  if (b_sides.all_zero()) return meet_degenerate(a, b);
  const PlaneSide plane_b(b[0], b[1], b[2]);
  const Sides a_sides = sides_of(plane_b, a, shared_a);
  // Here a's plane is well defined. All zero: b has no area.
  if (a_sides.all_strictly_same()) return Meet::disjoint;
  if (a_sides.all_zero()) return meet_degenerate(a, b);
  return meet_on_line(CrossingPlanes(a, a_sides, b, b_sides),
                      a_sides.strictly_mixed() && b_sides.strictly_mixed());
}

}  // namespace

Meet meet_triangles(const double* const a[3], const double* const b[3]) {
  bool shared_a[3] = {}, shared_b[3] = {};
  // FloatingPredicates measures plain double arithmetic, so no exact shortcut is taken.
  if (!only_floating()) {
    const Shared shared(a, b);
    // Two common corners: the triangles share an edge, and intersect only there or are coplanar; or one of
    // them has no area.
    if (shared.count >= 2) return Meet::touch;
    for (int i = 0; i < 3; ++i) {
      if (shared.with[i] < 0) continue;
      shared_a[i] = true;
      shared_b[shared.with[i]] = true;
    }
  }
  return meet_by_planes(a, shared_a, b, shared_b);
}

Meet meet_segments(const double* const a[2], const double* const b[2]) {
  // Segments intersect if and only if neither is strictly on one side of the other's line.
  const int b0 = orient2d(a[0], a[1], b[0]), b1 = orient2d(a[0], a[1], b[1]);
  if (b0 * b1 > 0) return Meet::disjoint;
  const int a0 = orient2d(b[0], b[1], a[0]), a1 = orient2d(b[0], b[1], a[1]);
  if (a0 * a1 > 0) return Meet::disjoint;
  // No zero: a proper crossing. Some zero, but not all: an end of one is on the other.
  if (a0 * a1 < 0 && b0 * b1 < 0) return Meet::cross;
  if (a0 != 0 || a1 != 0 || b0 != 0 || b1 != 0) return Meet::touch;
  // Collinear (or points): they intersect if and only if their bounding boxes do.
  for (int k = 0; k < 2; ++k) {
    const auto [a_low, a_high] = std::minmax(a[0][k], a[1][k]);
    const auto [b_low, b_high] = std::minmax(b[0][k], b[1][k]);
    if (a_high < b_low || b_high < a_low) return Meet::disjoint;
  }
  return Meet::touch;
}

// Embedding test of one pair of faces: they may intersect only in vertices and edges that they share by
// index. Cases by the number of shared vertices:
// - two: the third corners are not coplanar with the edge, or are on opposite sides of it;
// - one: the triangles' cones at the shared corner intersect in the corner only;
// - none: the triangles are disjoint.
// Faces without area never pass.

namespace {

/// The corners that two triangles share, by index: `count` pairs (a[in_a[i]], b[in_b[i]]).
struct SharedCorners {
  int count = 0;
  int in_a[3], in_b[3];
};

SharedCorners shared_corners(const VertexId ia[3], const VertexId ib[3]) {
  SharedCorners r;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (ia[i] != ib[j]) continue;
      if (r.count < 3) {
        r.in_a[r.count] = i;
        r.in_b[r.count] = j;
      }
      ++r.count;
      break;
    }
  }
  return r;
}

bool has_area(const PlaneSide& plane, const double* const t[3]) {
  return plane.surely_has_area() || !collinear3d(t[0], t[1], t[2]);
}

/// Tests two triangles that share the edge p, q; their third corners are r and s.
bool meet_only_in_edge(const double* p, const double* q, const double* r, const double* s) {
  // Two distinct planes intersect only in the line of the shared edge.
  if (orient3d(p, q, r, s) != 0) return true;
  const Axes axes = axes_for(p, q, r);  // coplanar, or one has no area
  return axes.turn != 0 && orient_axes(p, q, s, axes.x, axes.y) == -axes.turn;
}

/// Returns true if the closed cone v, c0, c1 (orientation `turn`, angle less than 180 degrees) contains the
/// point p, p != v.
bool cone_holds(const double* v, const double* c0, const double* c1, int turn, const double* p,
                const Axes& axes) {
  return orient_axes(v, c0, p, axes.x, axes.y) != -turn && orient_axes(v, p, c1, axes.x, axes.y) != -turn;
}

/// Returns true if two coplanar triangles with area intersect only in their shared corner v.
bool coplanar_cones_apart(const double* v, const double* a1, const double* a2, const double* b1,
                          const double* b2) {
  // Near v each triangle equals its cone. Two cones overlap if and only if one contains an edge ray of the
  // other.
  const Axes axes = axes_for(v, a1, a2);
  const int b_turn = orient_axes(v, b1, b2, axes.x, axes.y);
  return !cone_holds(v, a1, a2, axes.turn, b1, axes) && !cone_holds(v, a1, a2, axes.turn, b2, axes) &&
         !cone_holds(v, b1, b2, b_turn, a1, axes) && !cone_holds(v, b1, b2, b_turn, a2, axes);
}

/// Tests two triangles that share the corner v; each is listed from v in its own orientation.
bool meet_only_in_corner(const double* v, const double* a1, const double* a2, const double* b1,
                         const double* b2) {
  const double* const a[3] = {v, a1, a2};
  const double* const b[3] = {v, b1, b2};
  const PlaneSide plane_a(v, a1, a2), plane_b(v, b1, b2);
  if (!has_area(plane_a, a) || !has_area(plane_b, b)) return false;
  // Except for v, one triangle is strictly on one side of the other's plane: only v is shared.
  const int s1 = plane_a.side(b1), s2 = plane_a.side(b2);
  if (s1 * s2 > 0) return true;
  if (s1 == 0 && s2 == 0) return coplanar_cones_apart(v, a1, a2, b1, b2);
  // The same with the roles exchanged.
  const int t1 = plane_b.side(a1), t2 = plane_b.side(a2);
  if (t1 * t2 > 0) return true;
  // Each triangle contains a ray from v on the line in which the planes cross. Its direction along normal(a)
  // x normal(b) follows from which of the other two corners is higher: for a it is forward if that is the
  // first corner, for b if it is the second. (t1 = t2 = 0 is impossible: then b would be in a's plane.)
  return (t1 > t2) == (s1 > s2);
}

}  // namespace

bool meet_only_in_shared(const double* const a[3], const VertexId ia[3], const double* const b[3],
                         const VertexId ib[3]) {
  const SharedCorners shared = shared_corners(ia, ib);
  if (shared.count > 2) return false;
  // The corner numbers 0, 1, 2 add up to 3: subtracting two of them gives the third.
  const int i = shared.in_a[0], j = shared.in_b[0];
  if (shared.count == 2) {
    if (j == shared.in_b[1]) return false;  // a repeats a vertex: no area
    return meet_only_in_edge(a[i], a[shared.in_a[1]], a[3 - i - shared.in_a[1]], b[3 - j - shared.in_b[1]]);
  }
  // Rotate both triangles so that the shared corner comes first.
  if (shared.count == 1)
    return meet_only_in_corner(a[i], a[(i + 1) % 3], a[(i + 2) % 3], b[(j + 1) % 3], b[(j + 2) % 3]);
  return has_area(PlaneSide(a[0], a[1], a[2]), a) && has_area(PlaneSide(b[0], b[1], b[2]), b) &&
         meet_triangles(a, b) == Meet::disjoint;
}

bool meet_only_in_shared_2d(const double* const a[2], const VertexId ia[2], const double* const b[2],
                            const VertexId ib[2]) {
  const auto is_point = [](const double* const s[2]) { return s[0][0] == s[1][0] && s[0][1] == s[1][1]; };
  // A segment without length never passes.
  if (is_point(a) || is_point(b)) return false;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      if (ia[i] != ib[j]) continue;
      // Both vertices are shared: the same segment twice.
      if (ia[1 - i] == ib[1 - j]) return false;
      const double *v = a[i], *p = a[1 - i], *q = b[1 - j];
      if (orient2d(v, p, q) != 0) return true;
      // Collinear: the segments must leave v in opposite directions.
      for (int k = 0; k < 2; ++k) {
        if (p[k] != v[k]) return (p[k] > v[k]) != (q[k] > v[k]);
      }
    }
  }
  return meet_segments(a, b) == Meet::disjoint;
}

}  // namespace lrb::exact
