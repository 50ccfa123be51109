// The intersection of two triangles of which at least one has no area. All in rational arithmetic, because
// such pairs are rare.
// 1. Replace each triangle by its convex hull: a triangle, a segment or a point. Test these exactly.
// 2. Clip the hull of lower dimension, a segment or a point, by the other one (Cyrus and Beck 1978).
// 3. Return the ends of the part that is left, each with the features on which it lies.

#include <utility>
#include <vector>

#include "engine/exact/contact_parts.hpp"
#include "engine/exact/degenerate.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/exact/rational_interval.hpp"

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

/// Returns the feature of least dimension of triangle t, which may be degenerate, that contains the point x
/// of t.
Feature feature_of(const RationalVec& x, const double* const t[3]) {
  // Corners before edges before the inside: the first match is the feature of least dimension.
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
  // Three points always lie in one plane, so the test begins with the fourth.
  for (std::size_t i = 3; i < p.size();
       ++i) {  // at most a triangle first and two more points, or two segments
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

}  // namespace lrb::exact
