// The intersection of two triangles with exact combinatorics (interval overlap, Moeller 1997; by orientation
// signs alone, as in Guigue and Devillers 2003).
// 1. Sides of each triangle's corners on the other's plane. All strictly on one side: disjoint.
// 2. If the planes cross in a line L, each triangle covers a span of L. The contact is the spans' overlap.
// 3. Each end of the overlap gets its feature on both triangles, and coordinates.
// 4. Coplanar and degenerate triangles have functions of their own.

#include "engine/exact/pair_contact.hpp"

#include "engine/exact/contact_parts.hpp"
#include "engine/exact/degenerate.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/planes_cross.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::exact {
namespace {

/// Whether a point is at the low or the high end of a triangle's span on L. Neither: strictly inside the
/// span.
struct Place {
  bool low, high;
};

/// Returns the feature of least dimension of the triangle that contains a point of L.
Feature feature_on(const Span& span, const Sides& sides, const Place& place) {
  // Inside the span: L passes through the triangle's inside, or runs along its edge (low, high).
  if (!place.low && !place.high)
    return sides.strictly_mixed() ? Feature{2, 0} : edge_between(span.low, span.high);
  // At an end: a corner that lies in the other plane, or the point in which an edge from the tip crosses it.
  const int end = place.low ? span.low : span.high;
  return sides.s[end] == 0 ? corner(end) : edge_between(span.tip, end);
}

/// Returns a point of L that ends the span of at least one triangle.
ContactCorner corner_on_line(const CrossingPlanes& c, const Sides& a_sides, const Sides& b_sides,
                             const Place& on_a, const Place& on_b) {
  ContactCorner r;
  r.on_a = feature_on(c.on_a, a_sides, on_a);
  r.on_b = feature_on(c.on_b, b_sides, on_b);
  // Corners are copied. Otherwise the point is the crossing of an edge of the triangle whose span it ends.
  if (r.on_a.dim == 0) {
    r.x = as_vector(c.a[r.on_a.index]);
  } else if (r.on_b.dim == 0) {
    r.x = as_vector(c.b[r.on_b.index]);
  } else if (on_a.low || on_a.high) {
    r.x = cut_by_plane(c.a[c.on_a.tip], c.a[on_a.low ? c.on_a.low : c.on_a.high], c.b);
  } else {
    r.x = cut_by_plane(c.b[c.on_b.tip], c.b[on_b.low ? c.on_b.low : c.on_b.high], c.a);
  }
  return r;
}

PairContact contact_on_line(const double* const a[3], const Sides& a_sides, const double* const b[3],
                            const Sides& b_sides) {
  PairContact r;
  const CrossingPlanes c(a, a_sides, b, b_sides);
  // Positive: b's high end is above a's low end, and the reverse. Negative in either: the spans are disjoint.
  const int high_b_low_a = c.order(c.on_a.low, c.on_b.high);
  const int high_a_low_b = -c.order(c.on_a.high, c.on_b.low);
  if (high_b_low_a < 0 || high_a_low_b < 0) return r;
  // The triangles' relative interiors cover open intervals of L only if the other plane cuts them in two.
  const bool through = a_sides.strictly_mixed() && b_sides.strictly_mixed();
  r.meet = through && high_b_low_a > 0 && high_a_low_b > 0 ? Meet::cross : Meet::touch;
  // Signs of (b's low - a's low) and (b's high - a's high) along L.
  const int lows = c.order(c.on_a.low, c.on_b.low), highs = c.order(c.on_a.high, c.on_b.high);
  // The lower end of the intersection is the greater of the two low ends. It can be a high end too, and both
  // ends of one triangle if its span is a point.
  const Place low_on_a{lows <= 0, (lows <= 0 && c.on_a.is_point()) || (lows >= 0 && high_a_low_b == 0)};
  const Place low_on_b{lows >= 0, (lows >= 0 && c.on_b.is_point()) || (lows <= 0 && high_b_low_a == 0)};
  const Place high_on_a{(highs >= 0 && c.on_a.is_point()) || (highs <= 0 && high_b_low_a == 0), highs >= 0};
  const Place high_on_b{(highs <= 0 && c.on_b.is_point()) || (highs >= 0 && high_a_low_b == 0), highs <= 0};
  append(r, corner_on_line(c, a_sides, b_sides, low_on_a, low_on_b));
  // The overlap is a single point if a span is one, or if the spans only share an end.
  const bool is_point = c.on_a.is_point() || c.on_b.is_point() || high_b_low_a == 0 || high_a_low_b == 0;
  if (!is_point) append(r, corner_on_line(c, a_sides, b_sides, high_on_a, high_on_b));
  return r;
}

}  // namespace

PairContact contact_of_triangles(const double* const a[3], const double* const b[3]) {
  const PlaneSide plane_a(a[0], a[1], a[2]), plane_b(b[0], b[1], b[2]);
  const Sides b_sides = sides_of(plane_a, b);
  // A triangle strictly on one side of the other's plane: disjoint. The signs for b's plane come second.
  if (b_sides.all_strictly_same()) return {};
  const Sides a_sides = sides_of(plane_b, a);
  if (a_sides.all_strictly_same()) return {};
  // All zero: the triangles are coplanar, or one has no area and therefore no plane.
  if (!a_sides.all_zero() && !b_sides.all_zero()) return contact_on_line(a, a_sides, b, b_sides);
  if (collinear3d(a[0], a[1], a[2]) || collinear3d(b[0], b[1], b[2])) return contact_of_degenerate(a, b);
  return contact_in_plane(a, b);
}

}  // namespace lrb::exact
