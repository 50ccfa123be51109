// Embedding test of one pair of faces: they may intersect only in the vertices and edges that they share by
// index. Cases by the number of shared vertices:
// - two: the third corners are not coplanar with the edge, or lie on opposite sides of it;
// - one: the triangles' cones at the shared corner have only the corner in common;
// - none: the triangles are disjoint.
// Faces without area never pass.

#include "engine/exact/degenerate.hpp"
#include "engine/exact/orient_axes.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/exact/simplex_test.hpp"

namespace lrb::exact {
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
  // Two different planes intersect only in the line of the shared edge.
  if (orient3d(p, q, r, s) != 0) return true;
  const Axes axes = axes_for(p, q, r);  // coplanar, or one has no area
  return axes.turn != 0 && orient_axes(p, q, s, axes.x, axes.y) == -axes.turn;
}

/// Returns true if the closed cone v, c0, c1 (turning by `turn`, less than half a turn) holds the point p,
/// which is not v.
bool cone_holds(const double* v, const double* c0, const double* c1, int turn, const double* p,
                const Axes& axes) {
  return orient_axes(v, c0, p, axes.x, axes.y) != -turn && orient_axes(v, p, c1, axes.x, axes.y) != -turn;
}

/// Returns true if two coplanar triangles with area, which share the corner v, have nothing else in common.
bool coplanar_cones_apart(const double* v, const double* a1, const double* a2, const double* b1,
                          const double* b2) {
  // Near v each triangle equals its cone. Two cones overlap exactly if one contains an edge ray of the other.
  const Axes axes = axes_for(v, a1, a2);
  const int b_turn = orient_axes(v, b1, b2, axes.x, axes.y);
  return !cone_holds(v, a1, a2, axes.turn, b1, axes) && !cone_holds(v, a1, a2, axes.turn, b2, axes) &&
         !cone_holds(v, b1, b2, b_turn, a1, axes) && !cone_holds(v, b1, b2, b_turn, a2, axes);
}

/// Tests two triangles that share the corner v; each runs v, 1, 2 in its own order.
bool meet_only_in_corner(const double* v, const double* a1, const double* a2, const double* b1,
                         const double* b2) {
  const double* const a[3] = {v, a1, a2};
  const double* const b[3] = {v, b1, b2};
  const PlaneSide plane_a(v, a1, a2), plane_b(v, b1, b2);
  if (!has_area(plane_a, a) || !has_area(plane_b, b)) return false;
  // One triangle strictly on one side of the other's plane, but for v: only v is shared.
  const int s1 = plane_a.side(b1), s2 = plane_a.side(b2);
  if (s1 * s2 > 0) return true;
  if (s1 == 0 && s2 == 0) return coplanar_cones_apart(v, a1, a2, b1, b2);
  // The same with the roles exchanged.
  const int t1 = plane_b.side(a1), t2 = plane_b.side(a2);
  if (t1 * t2 > 0) return true;
  // Each triangle has a ray from v on the line in which the planes cross. Its direction along normal(a) x
  // normal(b) follows from which of the two other corners is the higher: for a it runs forward if that is the
  // first corner, for b if it is the second. (t1 = t2 = 0 cannot be: b would lie in a's plane.)
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
    if (j == shared.in_b[1]) return false;  // a names one vertex twice: no area
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
      // All on one line: the segments must leave v in opposite directions.
      for (int k = 0; k < 2; ++k) {
        if (p[k] != v[k]) return (p[k] > v[k]) != (q[k] > v[k]);
      }
    }
  }
  return meet_segments(a, b) == Meet::disjoint;
}

}  // namespace lrb::exact
