// Intersection of a ray in direction +x with one face, for point location by parity. The origin is perturbed
// symbolically by (0, eps, eps^2) (Edelsbrunner and Muecke 1990, "Simulation of Simplicity"), so that no ray
// passes through an edge or a corner, or within a face's plane.
// 1. Reject faces whose bounding box the ray misses.
// 2. Project along x: sides of the point relative to the three edges. Strictly on both sides: a miss.
// 3. Test exactly whether the point is on the face.
// 4. Replace zero sides by the sides of the perturbed point. All equal: the ray's line crosses the face.
// 5. The side of the plane decides whether the crossing is ahead of the origin or behind it.

#include "engine/exact/locate.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/geometry.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/exact/rational.hpp"

namespace lrb::exact {

RationalPoint::Coordinates::Coordinates(RationalVec coordinates) : x(std::move(coordinates)) {
  // The conversion has an error of at most one ulp. Widen until the doubles provably enclose the coordinate.
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = high[k] = x[k].convert_to<double>();
    while (to_rational(low[k]) > x[k]) low[k] = std::nextafter(low[k], -kInfinity);
    while (to_rational(high[k]) < x[k]) high[k] = std::nextafter(high[k], kInfinity);
  }
}

RationalPoint::RationalPoint(const double* p, int dim)
    : coordinates_(std::make_shared<const Coordinates>(to_rational(p, dim))) {}

RationalPoint RationalPoint::midpoint(const RationalPoint& a, const RationalPoint& b) {
  return make_point(between(a.coordinates().x, b.coordinates().x, Rational(1, 2)));
}

RationalPoint RationalPoint::combination(std::span<const RationalPoint> points,
                                         std::span<const double> weights) {
  // Weights are doubles, so sums and the quotient are exact rationals.
  RationalVec sum;
  Rational total = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Rational w = to_rational(weights[i]);
    for (std::size_t k = 0; k < 3; ++k) sum[k] += w * points[i].coordinates().x[k];
    total += w;
  }
  for (auto& s : sum) s /= total;
  return make_point(std::move(sum));
}

Eigen::Vector3d RationalPoint::rounded() const {
  return exact::rounded(coordinates_->x);
}

int orient2d(const double* a, const double* b, const RationalPoint& c) {
  return area_determinant(to_rational(a, 2), to_rational(b, 2), c.coordinates().x, 0, 1).sign();
}

int orient3d(const double* a, const double* b, const double* c, const RationalPoint& d) {
  return volume_determinant(to_rational(a), to_rational(b), to_rational(c), d.coordinates().x).sign();
}

namespace {

constexpr int kX = 0, kY = 1, kZ = 2;

/// The predicates of a query point: for doubles here, for rational coordinates below.
struct DoubleProbe {
  const double* p;

  int compare(int axis, double x) const { return (p[axis] > x) - (p[axis] < x); }
  bool surely_below(int axis, double x) const { return p[axis] < x; }
  bool surely_above(int axis, double x) const { return p[axis] > x; }
  int orient(const double* a, const double* b, int x, int y) const { return orient_axes(a, b, p, x, y); }
  int side(const double* const t[3]) const { return orient3d(t[0], t[1], t[2], p); }
};

struct RationalProbe {
  const RationalPoint::Coordinates& p;

  int compare(int axis, double x) const {
    // The enclosing doubles nearly always decide. Rational numbers are compared only inside that interval.
    if (surely_below(axis, x)) return -1;
    if (surely_above(axis, x)) return 1;
    const Rational& own = p.x[static_cast<std::size_t>(axis)];
    const Rational other = to_rational(x);
    return (own > other) - (own < other);
  }
  bool surely_below(int axis, double x) const { return p.high[static_cast<std::size_t>(axis)] < x; }
  bool surely_above(int axis, double x) const { return p.low[static_cast<std::size_t>(axis)] > x; }
  int orient(const double* a, const double* b, int x, int y) const {
    const int dim = std::max(x, y) + 1;
    return area_determinant(to_rational(a, dim), to_rational(b, dim), p.x, x, y).sign();
  }
  int side(const double* const t[3]) const {
    return volume_determinant(to_rational(t[0]), to_rational(t[1]), to_rational(t[2]), p.x).sign();
  }
};

template <class Probe>
bool in_box_of_segment(const Probe& p, const double* a, const double* b, int dim) {
  for (int k = 0; k < dim; ++k) {
    if (p.compare(k, std::min(a[k], b[k])) < 0 || p.compare(k, std::max(a[k], b[k])) > 0) return false;
  }
  return true;
}

/// Returns true if the point is on the triangle. The point must be in the triangle's plane, or the triangle
/// must have no area.
template <class Probe>
bool on_flat_triangle(const Probe& p, const double* const t[3]) {
  // Closed triangle: not strictly outside any edge, in a projection in which it has area.
  const Axes axes = axes_for(t[0], t[1], t[2]);
  if (axes.turn != 0) {
    return p.orient(t[0], t[1], axes.x, axes.y) != -axes.turn &&
           p.orient(t[1], t[2], axes.x, axes.y) != -axes.turn &&
           p.orient(t[2], t[0], axes.x, axes.y) != -axes.turn;
  }
  // No area: the triangle is the segment or point that its corners span.
  const Hull h = hull_of(t);
  const double *a = h.corner[0], *b = h.corner[h.dim];
  return in_box_of_segment(p, a, b, 3) && p.orient(a, b, kX, kY) == 0 && p.orient(a, b, kY, kZ) == 0 &&
         p.orient(a, b, kZ, kX) == 0;
}

/// Returns true if the ray, including its origin, misses the triangle's box.
template <class Probe>
bool passes_box(const Probe& p, const double* const t[3]) {
  // Strict comparisons: an origin level with a face of the box is left to the exact test.
  for (int k : {kY, kZ}) {
    if (p.surely_below(k, std::min({t[0][k], t[1][k], t[2][k]}))) return true;
    if (p.surely_above(k, std::max({t[0][k], t[1][k], t[2][k]}))) return true;
  }
  return p.surely_above(kX, std::max({t[0][kX], t[1][kX], t[2][kX]}));
}

/// Returns the side of the perturbed point relative to the line a, b, projected along x; `side` is that of
/// the point itself. The derivatives of the determinant with respect to eps and eps^2 are -(b_z - a_z) and
/// b_y - a_y.
int moved_side(int side, const double* a, const double* b) {
  // Nonzero sides do not change under the infinitesimal perturbation. Otherwise the first nonzero derivative
  // decides.
  if (side != 0) return side;
  if (a[kZ] != b[kZ]) return b[kZ] < a[kZ] ? 1 : -1;
  return (b[kY] > a[kY]) - (b[kY] < a[kY]);
}

template <class Probe>
RayHit ray_triangle(const Probe& p, const double* const t[3]) {
  if (passes_box(p, t)) return RayHit::misses;
  int s[3];
  bool left = false, right = false;
  for (int i = 0; i < 3; ++i) {
    s[i] = p.orient(t[i], t[(i + 1) % 3], kY, kZ);
    left |= s[i] > 0;
    right |= s[i] < 0;
  }
  // In the projection along x, the point is strictly outside the triangle, and so is the perturbed point.
  if (left && right) return RayHit::misses;
  // The point itself is in the plane: it is on the triangle, or the perturbed ray misses the triangle.
  const int side = p.side(t);
  if (side == 0 && on_flat_triangle(p, t)) return RayHit::on_face;
  if (side == 0) return RayHit::misses;
  // turn = 0: the projection of the edge along x is a point, so the triangle is seen edge-on and has no
  // interior.
  const int turn = moved_side(s[0], t[0], t[1]);
  if (turn == 0 || moved_side(s[1], t[1], t[2]) != turn || moved_side(s[2], t[2], t[0]) != turn) {
    return RayHit::misses;
  }
  // Seen along x, the triangle's orientation is the sign of the x component of its normal: the plane is ahead
  // if p is behind it.
  return side == -turn ? RayHit::crosses : RayHit::misses;
}

template <class Probe>
RayHit ray_segment(const Probe& p, const double* const s[2]) {
  // Orient the segment upwards, so that "left" means smaller x.
  const double* lower = s[0][kY] <= s[1][kY] ? s[0] : s[1];
  const double* upper = s[0][kY] <= s[1][kY] ? s[1] : s[0];
  if (p.surely_below(kY, lower[kY]) || p.surely_above(kY, upper[kY])) return RayHit::misses;
  if (p.surely_above(kX, std::max(s[0][kX], s[1][kX]))) return RayHit::misses;
  const int left = p.orient(lower, upper, kX, kY);
  if (left == 0 && in_box_of_segment(p, lower, upper, 2)) return RayHit::on_face;
  // The perturbed point is above every end level with p: the interval is closed below and open above.
  const bool spans = p.compare(kY, lower[kY]) >= 0 && p.compare(kY, upper[kY]) < 0;
  return spans && left > 0 ? RayHit::crosses : RayHit::misses;
}

}  // namespace

RayHit ray_crosses(const double p[3], const double* const tri[3]) {
  return ray_triangle(DoubleProbe{p}, tri);
}
RayHit ray_crosses(const RationalPoint& p, const double* const tri[3]) {
  return ray_triangle(RationalProbe{p.coordinates()}, tri);
}
RayHit ray_crosses_2d(const double p[2], const double* const seg[2]) {
  return ray_segment(DoubleProbe{p}, seg);
}
RayHit ray_crosses_2d(const RationalPoint& p, const double* const seg[2]) {
  return ray_segment(RationalProbe{p.coordinates()}, seg);
}

}  // namespace lrb::exact
