// The intersection of two triangles, at least one of which has no area. All in rational arithmetic, because
// such pairs are rare.
// 1. Replace each triangle by its convex hull: a triangle, a segment or a point. Test these exactly.
// 2. Clip the hull of smaller dimension, a segment or a point, to the other one.
// 3. Return the end points of the remaining part, each with the features that contain it.

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/exact/predicates.hpp"
#include "engine/exact/rational.hpp"
#include "engine/exact/simplex_parts.hpp"

namespace lrb::exact {
namespace {

struct RationalHull {
  std::vector<RationalVec> corner;
};

RationalHull rational_hull(const Hull& h) {
  RationalHull r;
  for (int i = 0; i <= h.dim; ++i) r.corner.push_back(to_rational(h.corner[i]));
  return r;
}

void clip_by_triangle(RationalInterval& part, const RationalHull& t, const Axes& axes, const RationalVec& s,
                      const RationalVec& e) {
  // Keep the part in the triangle's plane: a single point unless the segment lies in the plane.
  const auto& c = t.corner;
  part.keep_zero(volume_determinant(c[0], c[1], c[2], s), volume_determinant(c[0], c[1], c[2], e));
  // Keep the part on the inner side of each edge. axes.turn makes that side positive in the projection.
  for (std::size_t i = 0; i < 3; ++i) {
    const RationalVec &p = c[i], &q = c[(i + 1) % 3];
    part.keep_positive(axes.turn * area_determinant(p, q, s, axes.x, axes.y),
                       axes.turn * area_determinant(p, q, e, axes.x, axes.y));
  }
}

void clip_by_segment(RationalInterval& part, const RationalVec& p, const RationalVec& q, const RationalVec& s,
                     const RationalVec& e) {
  // A point is on the line p, q if its projections on all three coordinate planes are on the projected line.
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3;
    part.keep_zero(area_determinant(p, q, s, x, y), area_determinant(p, q, e, x, y));
  }
  // On that line, the segment is the part inside its bounding box.
  for (std::size_t k = 0; k < 3; ++k) {
    const Rational &low = p[k] < q[k] ? p[k] : q[k], &high = p[k] < q[k] ? q[k] : p[k];
    part.keep_positive(s[k] - low, e[k] - low);
    part.keep_positive(high - s[k], high - e[k]);
  }
}

bool on_segment(const RationalVec& x, const RationalVec& p, const RationalVec& q) {
  RationalInterval part;
  clip_by_segment(part, p, q, x, x);
  return !part.empty;
}

/// Returns the feature of lowest dimension of triangle t, which may be degenerate, that contains the point x
/// of t.
Feature feature_of(const RationalVec& x, const double* const t[3]) {
  // Corners before edges before the interior: the first match is the feature of lowest dimension.
  for (int i = 0; i < 3; ++i) {
    if (x == to_rational(t[i])) return corner(i);
  }
  for (int i = 0; i < 3; ++i) {
    if (on_segment(x, to_rational(t[i]), to_rational(t[(i + 1) % 3]))) return edge_between(i, (i + 1) % 3);
  }
  return {2, 0};
}

bool in_one_plane(const Hull& a, const Hull& b) {
  std::vector<const double*> p(a.corner, a.corner + a.dim + 1);
  p.insert(p.end(), b.corner, b.corner + b.dim + 1);
  // Any three points are coplanar, so the test begins with the fourth.
  for (std::size_t i = 3; i < p.size(); ++i) {  // at most a triangle and two more points, or two segments
    if (orient3d(p[0], p[1], p[2], p[i]) != 0) return false;
  }
  return true;
}

}  // namespace

PairContact contact_of_degenerate(const double* const a[3], const double* const b[3]) {
  Hull big = hull_of(a), small = hull_of(b);
  // At most one of the hulls is a triangle, so `small` is a segment or a point.
  if (big.dim < small.dim) std::swap(big, small);
  PairContact r;
  r.coplanar = in_one_plane(big, small);
  if (!hulls_meet(big, small)) return r;
  r.meet = Meet::touch;
  // The hulls intersect, so clipping leaves a part. If `small` is a point, s and e are equal.
  const RationalHull outer = rational_hull(big);
  const RationalVec s = to_rational(small.corner[0]), e = to_rational(small.corner[small.dim]);
  RationalInterval part;
  if (big.dim == 2) {
    clip_by_triangle(part, outer, axes_for(big.corner[0], big.corner[1], big.corner[2]), s, e);
  } else {
    clip_by_segment(part, outer.corner.front(), outer.corner.back(), s, e);
  }
  // One corner if the part is a point. Features are found for the exact point; rounding comes last.
  const bool is_point = part.low == part.high || small.dim == 0;
  for (const Rational& t : {part.low, part.high}) {
    const RationalVec x = between(s, e, t);
    append(r, {rounded(x), feature_of(x, a), feature_of(x, b)});
    if (is_point) break;
  }
  return r;
}

// The intersection of two coplanar triangles with area, and of two segments in the plane. The first is a
// convex polygon, whose corners are corners of A in B, corners of B in A, and crossings of two edges.
// 1. Project to two coordinates and compute the side of each corner on each edge of the other triangle.
// 2. Collect the corners of all three kinds. These signs decide everything; coordinates are only output.
// 3. Order the corners around the polygon.

namespace {

/// Sides of the corners of one triangle relative to the edges of another: side[i][k] is the side of corner k
/// relative to the directed edge i, +1 inside.
struct EdgeSides {
  int side[3][3];
};

EdgeSides edge_sides(const double* const edges[3], const double* const corners[3], const Axes& axes) {
  // The projection may reverse the orientation. `turn` makes +1 the inner side of each edge.
  const int turn = orient_axes(edges[0], edges[1], edges[2], axes.x, axes.y);
  EdgeSides r;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      r.side[i][k] = turn * orient_axes(edges[i], edges[(i + 1) % 3], corners[k], axes.x, axes.y);
    }
  }
  return r;
}

/// Locates corner k in the triangle of the edges. Returns false if it is outside.
bool locate_corner(const EdgeSides& s, int k, Feature& f) {
  // Strictly outside one edge: outside the triangle. The zeros count the edges that contain the corner.
  int zeros = 0, zero_edge = 0;
  for (int i = 0; i < 3; ++i) {
    if (s.side[i][k] < 0) return false;
    if (s.side[i][k] > 0) continue;
    ++zeros;
    zero_edge = i;
  }
  if (zeros == 0) f = {2, 0};
  if (zeros == 1) f = {1, static_cast<std::uint8_t>(zero_edge)};
  // A point on both edges i and i + 1 is the corner between them, i + 1.
  if (zeros == 2) f = corner(s.side[0][k] != 0 ? 2 : s.side[1][k] != 0 ? 0 : 1);
  return true;
}

bool on_edge(const Feature& f, int edge) {
  return f.dim == 1 ? f.index == edge : f.dim == 0 && (f.index == edge || f.index == (edge + 1) % 3);
}

/// Returns true if two corners of the polygon are known to be adjacent: both lie on one edge of either
/// triangle, whose line supports the convex polygon.
bool are_neighbours(const ContactCorner& p, const ContactCorner& q) {
  for (int i = 0; i < 3; ++i) {
    if (on_edge(p.on_a, i) && on_edge(q.on_a, i)) return true;
    if (on_edge(p.on_b, i) && on_edge(q.on_b, i)) return true;
  }
  return false;
}

/// Orders the corners around the polygon.
void order_round(PairContact& r) {
  // Selection sort: move a neighbour of the previous corner to position i. There are at most six corners.
  for (int i = 1; i < r.corner_count; ++i) {
    const auto from = r.corners.begin() + i;
    const auto end = r.corners.begin() + r.corner_count;
    const auto next =
        std::find_if(from, end, [&](const ContactCorner& q) { return are_neighbours(*(from - 1), q); });
    if (next != end) std::swap(*from, *next);
  }
}

ContactCorner at_corner(const double* p, Feature on_a, Feature on_b) {
  return {as_vector(p), on_a, on_b};
}

/// Returns true if edge i of a and edge j of b cross in their interiors.
bool edges_cross(const EdgeSides& b_in_a, const EdgeSides& a_in_b, int i, int j) {
  return b_in_a.side[i][j] * b_in_a.side[i][(j + 1) % 3] < 0 &&
         a_in_b.side[j][i] * a_in_b.side[j][(i + 1) % 3] < 0;
}

Eigen::Vector3d planar(const double* p) {
  return {p[0], p[1], 0};
}

Feature end_or_inside(int side_of_0, int side_of_1) {
  return side_of_0 == 0 ? corner(0) : side_of_1 == 0 ? corner(1) : Feature{1, 0};
}

/// Locates a point p of the line of segment s on s. Returns false if it is beyond the ends.
bool locate_on_segment(const double* p, const double* const s[2], Feature& f) {
  // The ends first, so that the feature of lowest dimension is reported.
  for (int i = 0; i < 2; ++i) {
    if (p[0] == s[i][0] && p[1] == s[i][1]) {
      f = corner(i);
      return true;
    }
  }
  // p is on the line of s, so it is on s if and only if it is in the bounding box of s.
  for (int k = 0; k < 2; ++k) {
    const auto [low, high] = std::minmax(s[0][k], s[1][k]);
    if (p[k] < low || p[k] > high) return false;
  }
  f = {1, 0};
  return true;
}

/// Intersects two collinear segments (or points): collects the ends of each that are on the other.
PairContact contact_on_one_line(const double* const a[2], const double* const b[2]) {
  PairContact r;
  r.coplanar = true;
  // A common end of both segments is found twice and added once.
  const auto add = [&](const double* p, Feature on_a, Feature on_b) {
    for (int i = 0; i < r.corner_count; ++i) {
      const Eigen::Vector3d& x = r.corners[static_cast<std::size_t>(i)].x;
      if (x[0] == p[0] && x[1] == p[1]) return;
    }
    append(r, {planar(p), on_a, on_b});
  };
  Feature f;
  for (int i = 0; i < 2; ++i) {
    if (locate_on_segment(a[i], b, f)) add(a[i], corner(i), f);
  }
  for (int j = 0; j < 2; ++j) {
    if (locate_on_segment(b[j], a, f)) add(b[j], f, corner(j));
  }
  r.meet = r.corner_count > 0 ? Meet::touch : Meet::disjoint;
  return r;
}

}  // namespace

PairContact contact_in_plane(const double* const a[3], const double* const b[3]) {
  PairContact r;
  r.coplanar = true;
  // Step 1: 18 signs in a projection in which the triangles have area.
  const Axes axes = axes_for(a[0], a[1], a[2]);
  const EdgeSides b_in_a = edge_sides(a, b, axes), a_in_b = edge_sides(b, a, axes);
  Feature f;
  // Step 2: corners of A in B, corners of B in A, crossings of edges. Only crossings have rounded
  // coordinates.
  for (int k = 0; k < 3; ++k) {
    if (locate_corner(a_in_b, k, f)) append(r, at_corner(a[k], corner(k), f));
  }
  for (int k = 0; k < 3; ++k) {  // a corner of both was added above
    if (locate_corner(b_in_a, k, f) && f.dim != 0) append(r, at_corner(b[k], f, corner(k)));
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (!edges_cross(b_in_a, a_in_b, i, j)) continue;
      const Eigen::Vector3d x = cut_by_line(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3], axes.x, axes.y, 3);
      append(r, {x, edge_between(i, (i + 1) % 3), edge_between(j, (j + 1) % 3)});
    }
  }
  // Step 3. Coplanar triangles never cross: by definition their contact is a touch.
  order_round(r);
  r.meet = r.corner_count > 0 ? Meet::touch : Meet::disjoint;
  return r;
}

PairContact contact_of_segments(const double* const a[2], const double* const b[2]) {
  const int b0 = orient2d(a[0], a[1], b[0]), b1 = orient2d(a[0], a[1], b[1]);
  const int a0 = orient2d(b[0], b[1], a[0]), a1 = orient2d(b[0], b[1], a[1]);
  // All four ends are on one line.
  if (a0 == 0 && a1 == 0 && b0 == 0 && b1 == 0) return contact_on_one_line(a, b);
  PairContact r;
  // One segment is strictly on one side of the other's line. Segments of length zero end here at the latest.
  if (a0 * a1 > 0 || b0 * b1 > 0) return r;
  // The lines cross in one point, which is on both segments. No sign is zero: a proper crossing.
  r.meet = a0 * a1 < 0 && b0 * b1 < 0 ? Meet::cross : Meet::touch;
  const Feature on_a = end_or_inside(a0, a1), on_b = end_or_inside(b0, b1);
  // Copy the coordinates of an end if the point is one. Otherwise compute the crossing.
  if (on_a.dim == 0) {
    append(r, {planar(a[on_a.index]), on_a, on_b});
  } else if (on_b.dim == 0) {
    append(r, {planar(b[on_b.index]), on_a, on_b});
  } else {
    append(r, {cut_by_line(a[0], a[1], b[0], b[1], 0, 1, 2), on_a, on_b});
  }
  return r;
}

}  // namespace lrb::exact
