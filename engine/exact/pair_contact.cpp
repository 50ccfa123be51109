// The intersection of two triangles with exact combinatorics (interval overlap, Moeller 1997; by orientation
// signs alone, as in Guigue and Devillers 2003).
// 1. Sides of each triangle's corners on the other's plane. All strictly on one side: disjoint.
// 2. If the planes cross in a line L, each triangle covers an interval (span) of L. The contact is the
//    overlap.
// 3. Each end of the overlap gets its feature on both triangles, and coordinates.
// 4. Coplanar and degenerate triangles are handled separately.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/exact/rational.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::exact {

// The intersection of a plane, or a line in 2D, with a segment p, q. With hp and hq the signed heights of the
// ends, it is p + t (q - p) with t = hp / (hp - hq).
// 1. Compute both heights in doubles, each with a bound on its error.
// 2. If the errors are small relative to hp - hq, interpolate in doubles.
// 3. Otherwise compute the point exactly and round it once: in integers of a fixed size if the coordinates
//    differ by few powers of two, which takes no memory allocation and no greatest common divisors; in
//    rational numbers if not.

namespace {

/// Returns the determinant of orient2d in two coordinates. The bound covers underflow (predicates.hpp).
Approximate area(const double* a, const double* b, const double* c, int x, int y) {
  constexpr double kTiny = 0x1p-1000;
  const double left = (b[x] - a[x]) * (c[y] - a[y]), right = (b[y] - a[y]) * (c[x] - a[x]);
  return {left - right, 5 * 0x1p-53 * (std::fabs(left) + std::fabs(right)) + kTiny};
}

/// Computes the parameter t = hp / (hp - hq) of the zero between two heights of opposite sign. Returns false
/// unless t is accurate, that is, unless the errors are small relative to hp - hq: with E the sum of both
/// errors, |error of t| <= 2 E / (|hp - hq| - E), plus three roundings.
bool parameter(const Approximate& hp, const Approximate& hq, double& t) {
  constexpr double kGoodEnough = 0x1p-45;  // 3e-14: then 2 E / (...) + 3 roundings stays under 1e-13
  // The comparison is written so that NaN (an overflow) fails it.
  const double rise = std::fabs(hp.value - hq.value);
  if (!(hp.error + hq.error <= kGoodEnough * rise) || !std::isfinite(rise)) return false;
  // Rounding can move t past an end by an ulp.
  t = std::clamp(hp.value / (hp.value - hq.value), 0.0, 1.0);
  return true;
}

/// Computes the point p + t (q - p). Returns false if a difference of coordinates overflows.
bool interpolate(const double* p, const double* q, double t, int dim, Eigen::Vector3d& r) {
  r.setZero();
  // Start from the closer end, so that the result is as accurate near q as near p.
  for (int k = 0; k < dim; ++k) r[k] = t <= 0.5 ? p[k] + t * (q[k] - p[k]) : q[k] + (1 - t) * (p[k] - q[k]);
  return r.allFinite();
}

// Points scaled by a common power of two, as integers. With coordinates of kCoordinateBits bits a determinant
// has at most 3 (kCoordinateBits + 1) + 3 bits, and its product with a coordinate 4 (kCoordinateBits + 1)
// + 4.

constexpr int kCoordinateBits = 240;
using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<1024, 1024, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;
using IntegerVec = std::array<Integer, 3>;

class ScaledPoints {
 public:
  /// Finds the scale of the first `dim` coordinates of some points.
  ScaledPoints(std::initializer_list<const double*> points, int dim) : dim_(dim) {
    int most = -kFar;
    for (const double* p : points)
      for (int k = 0; k < dim; ++k) {
        if (p[k] == 0) continue;
        const int exponent = std::ilogb(p[k]);
        most = std::max(most, exponent);
        least_ = std::min(least_, exponent - 52);  // the weight of the last bit of the mantissa
      }
    fits_ = most - least_ < kCoordinateBits && least_ > -kFar && most < kFar;
  }
  bool fits() const { return fits_; }

  IntegerVec of(const double* p) const {
    IntegerVec out;
    for (int k = 0; k < dim_; ++k) {
      if (p[k] == 0) continue;
      const int exponent = std::ilogb(p[k]) - 52;
      Integer& x = out[static_cast<std::size_t>(k)];
      x = static_cast<std::int64_t>(std::ldexp(p[k], -exponent));
      x <<= exponent - least_;
    }
    return out;
  }

  /// Returns the point p + hp / (hp - hq) (q - p), each coordinate rounded to the nearest double.
  Eigen::Vector3d between(const IntegerVec& p, const IntegerVec& q, const Integer& hp,
                          const Integer& hq) const {
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    const Integer rise = hp - hq;
    for (int k = 0; k < dim_; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Integer numerator = p[i] * rise + hp * (q[i] - p[i]);
      out[k] = quotient(numerator, rise);
    }
    return out;
  }

 private:
  static constexpr int kFar = 900;  ///< exponents in which neither scaling nor the result leaves the range

  /// Returns n / d scaled back, rounded to nearest, ties to even.
  double quotient(Integer n, Integer d) const {
    if (n.is_zero()) return 0;
    const bool negative = (n.sign() < 0) != (d.sign() < 0);
    n = abs(n);
    d = abs(d);
    // Take 56 or 57 bits of the quotient. If there is a remainder, set the last bit: they then round as the
    // exact quotient does.
    const int shift = 56 - (static_cast<int>(msb(n)) - static_cast<int>(msb(d)));
    shift >= 0 ? n <<= shift : d <<= -shift;
    Integer bits, remainder;
    divide_qr(n, d, bits, remainder);
    const auto mantissa = static_cast<std::uint64_t>(bits) | (remainder.is_zero() ? 0U : 1U);
    const double x = std::ldexp(static_cast<double>(mantissa), least_ - shift);
    return negative ? -x : x;
  }

  int dim_;
  int least_ = kFar;
  bool fits_ = false;
};

}  // namespace

Eigen::Vector3d cut_by_plane(const double* p, const Approximate& hp, const double* q, const Approximate& hq,
                             const double* const t[3]) {
  double s = 0;
  Eigen::Vector3d r;
  // Fast path in doubles, then the exact path for nearly parallel segments and for overflow.
  if (parameter(hp, hq, s) && interpolate(p, q, s, 3, r)) return r;
  if (const ScaledPoints scaled({p, q, t[0], t[1], t[2]}, 3); scaled.fits()) {
    const IntegerVec ip = scaled.of(p), iq = scaled.of(q);
    const IntegerVec a = scaled.of(t[0]), b = scaled.of(t[1]), c = scaled.of(t[2]);
    return scaled.between(ip, iq, volume_determinant(a, b, c, ip), volume_determinant(a, b, c, iq));
  }
  const RationalVec rp = to_rational(p), rq = to_rational(q);
  const RationalVec a = to_rational(t[0]), b = to_rational(t[1]), c = to_rational(t[2]);
  const Rational exact_hp = volume_determinant(a, b, c, rp), exact_hq = volume_determinant(a, b, c, rq);
  return rounded(between(rp, rq, exact_hp / (exact_hp - exact_hq)));
}

namespace {

/// Returns the intersection of the segment p, q with the line through a and b, in the projection to
/// coordinates x and y. Fills the first `dim` coordinates of the result and sets the others to 0. p must not
/// be on the line, nor q strictly on p's side of it. Same accuracy.
Eigen::Vector3d cut_by_line(const double* p, const double* q, const double* a, const double* b, int x, int y,
                            int dim) {
  double s = 0;
  Eigen::Vector3d r;
  // The same two paths, with areas instead of volumes.
  if (parameter(area(a, b, p, x, y), area(a, b, q, x, y), s) && interpolate(p, q, s, dim, r)) return r;
  if (const ScaledPoints scaled({p, q, a, b}, dim); scaled.fits()) {
    const IntegerVec ip = scaled.of(p), iq = scaled.of(q), ia = scaled.of(a), ib = scaled.of(b);
    return scaled.between(ip, iq, area_determinant(ia, ib, ip, x, y), area_determinant(ia, ib, iq, x, y));
  }
  const RationalVec rp = to_rational(p, dim), rq = to_rational(q, dim);
  const RationalVec ra = to_rational(a, dim), rb = to_rational(b, dim);
  const Rational hp = area_determinant(ra, rb, rp, x, y), hq = area_determinant(ra, rb, rq, x, y);
  return rounded(between(rp, rq, hp / (hp - hq)));
}

// Parts of contacts.

Feature corner(int i) {
  return {0, static_cast<std::uint8_t>(i)};
}
/// Returns the edge of a triangle between its corners i and j.
Feature edge_between(int i, int j) {
  return {1, static_cast<std::uint8_t>((i + 1) % 3 == j ? i : j)};
}

Eigen::Vector3d as_vector(const double* p) {
  return {p[0], p[1], p[2]};
}

void append(PairContact& r, const ContactCorner& c) {
  r.corners[r.corner_count++] = c;
}

// The intersection of two triangles, at least one of which has no area. All in rational arithmetic, because
// such pairs are rare.
// 1. Replace each triangle by its convex hull: a triangle, a segment or a point. Test these exactly.
// 2. Clip the hull of smaller dimension, a segment or a point, to the other one.
// 3. Return the end points of the remaining part, each with the features that contain it.

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

/// Intersects two triangles, at least one of which has no area: a segment, a point or nothing.
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

/// Intersects two coplanar triangles with area: a polygon, a segment, a point or nothing.
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

// Two triangles in planes that cross in a line L.

/// Whether a point is the low or the high end of a triangle's span on L. Neither: strictly inside the span.
struct Place {
  bool low, high;
};

/// Returns the feature of lowest dimension of the triangle that contains a point of L.
Feature feature_on(const Span& span, const Sides& sides, const Place& place) {
  // Inside the span: L passes through the triangle's interior, or along its edge (low, high).
  if (!place.low && !place.high)
    return sides.strictly_mixed() ? Feature{2, 0} : edge_between(span.low, span.high);
  // At an end: a corner in the other plane, or the point in which an edge from the tip crosses that plane.
  const int end = place.low ? span.low : span.high;
  return sides.s[end] == 0 ? corner(end) : edge_between(span.tip, end);
}

/// The corners of a triangle relative to the plane of the other one.
struct Heights {
  Approximate determinant[3];
  Sides sides;
};

Heights heights_over(const PlaneSide& plane, const double* const t[3]) {
  Heights r;
  for (int i = 0; i < 3; ++i) {
    r.determinant[i] = plane.determinant(t[i]);
    r.sides.s[i] = plane.side(t[i], r.determinant[i]);
  }
  return r;
}

/// Returns the point in which the edge from a triangle's tip to corner `end` crosses the plane of the other
/// one.
Eigen::Vector3d cut_edge(const double* const triangle[3], const Heights& heights, int tip, int end,
                         const double* const plane[3]) {
  return cut_by_plane(triangle[tip], heights.determinant[tip], triangle[end], heights.determinant[end],
                      plane);
}

/// Returns a point of L that is an end of the span of at least one triangle.
ContactCorner corner_on_line(const CrossingPlanes& c, const Heights& a, const Heights& b, const Place& on_a,
                             const Place& on_b) {
  ContactCorner r;
  r.on_a = feature_on(c.on_a, a.sides, on_a);
  r.on_b = feature_on(c.on_b, b.sides, on_b);
  // Corners are copied. Otherwise the point is the crossing of an edge of the triangle whose span it ends.
  if (r.on_a.dim == 0) {
    r.x = as_vector(c.a[r.on_a.index]);
  } else if (r.on_b.dim == 0) {
    r.x = as_vector(c.b[r.on_b.index]);
  } else if (on_a.low || on_a.high) {
    r.x = cut_edge(c.a, a, c.on_a.tip, on_a.low ? c.on_a.low : c.on_a.high, c.b);
  } else {
    r.x = cut_edge(c.b, b, c.on_b.tip, on_b.low ? c.on_b.low : c.on_b.high, c.a);
  }
  return r;
}

PairContact contact_on_line(const double* const a[3], const Heights& on_a, const double* const b[3],
                            const Heights& on_b) {
  const Sides &a_sides = on_a.sides, &b_sides = on_b.sides;
  PairContact r;
  const CrossingPlanes c(a, a_sides, b, b_sides);
  // Signs of b's low and high end minus an end of a along L. If b's high end is below a's low end, or b's low
  // end above a's high end, the spans are disjoint.
  const CrossingPlanes::Orders from_low = c.orders(c.on_a.low), from_high = c.orders(c.on_a.high);
  const int high_b_low_a = from_low.high, high_a_low_b = -from_high.low;
  if (high_b_low_a < 0 || high_a_low_b < 0) return r;
  // The triangles' relative interiors cover open intervals of L only if the other plane divides them.
  const bool through = a_sides.strictly_mixed() && b_sides.strictly_mixed();
  r.meet = through && high_b_low_a > 0 && high_a_low_b > 0 ? Meet::cross : Meet::touch;
  const int lows = from_low.low, highs = from_high.high;
  // The lower end of the intersection is the greater of the two low ends. It can also be a high end, and both
  // ends of one triangle if its span is a point.
  const Place low_on_a{lows <= 0, (lows <= 0 && c.on_a.is_point()) || (lows >= 0 && high_a_low_b == 0)};
  const Place low_on_b{lows >= 0, (lows >= 0 && c.on_b.is_point()) || (lows <= 0 && high_b_low_a == 0)};
  const Place high_on_a{(highs >= 0 && c.on_a.is_point()) || (highs <= 0 && high_b_low_a == 0), highs >= 0};
  const Place high_on_b{(highs <= 0 && c.on_b.is_point()) || (highs >= 0 && high_a_low_b == 0), highs <= 0};
  append(r, corner_on_line(c, on_a, on_b, low_on_a, low_on_b));
  // The overlap is a single point if a span is one, or if the spans share only an end.
  const bool is_point = c.on_a.is_point() || c.on_b.is_point() || high_b_low_a == 0 || high_a_low_b == 0;
  if (!is_point) append(r, corner_on_line(c, on_a, on_b, high_on_a, high_on_b));
  return r;
}

}  // namespace

PairContact contact_of_triangles(const double* const a[3], const double* const b[3]) {
  const PlaneSide plane_a(a[0], a[1], a[2]), plane_b(b[0], b[1], b[2]);
  const Heights on_b = heights_over(plane_a, b);
  // A triangle strictly on one side of the other's plane: disjoint. The signs for b's plane come second.
  if (on_b.sides.all_strictly_same()) return {};
  const Heights on_a = heights_over(plane_b, a);
  if (on_a.sides.all_strictly_same()) return {};
  // All zero: the triangles are coplanar, or one has no area and therefore no plane.
  if (!on_a.sides.all_zero() && !on_b.sides.all_zero()) return contact_on_line(a, on_a, b, on_b);
  if (collinear3d(a[0], a[1], a[2]) || collinear3d(b[0], b[1], b[2])) return contact_of_degenerate(a, b);
  return contact_in_plane(a, b);
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
