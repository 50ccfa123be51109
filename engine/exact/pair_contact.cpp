// The intersection of two triangles with exact combinatorics (interval overlap, Moeller 1997; by orientation
// signs alone, as in Guigue and Devillers 2003).
// 1. Sides of each triangle's corners on the other's plane. All strictly on one side: disjoint.
// 2. If the planes cross in a line L, each triangle covers an interval (span) of L. The contact is the
//    overlap.
// 3. Each end of the overlap gets its feature on both triangles, and coordinates.
// 4. Coplanar and degenerate triangles are handled separately.

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/exact/rational.hpp"
#include "engine/exact/simplex_parts.hpp"
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

namespace {

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

}  // namespace lrb::exact
