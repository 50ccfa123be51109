// The point in which a plane, or a line in 2D, cuts a segment p, q. With hp and hq the signed heights of the
// ends, it is p + t (q - p) with t = hp / (hp - hq).
// 1. Compute both heights in doubles, each with a bound on its error.
// 2. If the errors are small beside hp - hq, interpolate in doubles.
// 3. Otherwise compute the point in rational numbers and round it once.

#include "engine/exact/cut_point.hpp"

#include <algorithm>
#include <cmath>

#include "engine/exact/rational.hpp"

namespace lrb::exact {
namespace {

/// A determinant in doubles and a bound on its error, derived as in plane_side.hpp and orient_axes.hpp
/// (underflow is included; overflow makes the bound infinite or not a number).
struct Approximate {
  double value, error;
};

constexpr double kTiny = 0x1p-1000;

Approximate volume(const double* a, const double* b, const double* c, const double* d) {
  constexpr double kTinyProduct = 0x1p-900;
  // The sum of the same terms by magnitude bounds the error of the determinant (plane_side.hpp).
  double value = 0, magnitude = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double left = (b[i] - a[i]) * (c[j] - a[j]), right = (b[j] - a[j]) * (c[i] - a[i]);
    const double w = d[k] - a[k];
    value += (left - right) * w;
    magnitude += (std::fabs(left) + std::fabs(right) + kTinyProduct) * std::fabs(w);
  }
  return {value, 9 * 0x1p-53 * magnitude + kTiny};
}

Approximate area(const double* a, const double* b, const double* c, int x, int y) {
  // Four roundings at most; 5 units cover them (orient_axes.hpp).
  const double left = (b[x] - a[x]) * (c[y] - a[y]), right = (b[y] - a[y]) * (c[x] - a[x]);
  return {left - right, 5 * 0x1p-53 * (std::fabs(left) + std::fabs(right)) + kTiny};
}

/// Finds the parameter t = hp / (hp - hq) at which a height changes from hp to hq, of opposite sign, through
/// 0. Returns false unless t is accurate, that is, unless the errors are small beside hp - hq: with E the sum
/// of both errors, |error of t| <= 2 E / (|hp - hq| - E), plus three roundings.
bool parameter(const Approximate& hp, const Approximate& hq, double& t) {
  constexpr double kGoodEnough = 0x1p-45;  // 3e-14: then 2 E / (...) + 3 roundings stays under 1e-13
  // The comparison is written so that NaN (an overflow) fails it.
  const double rise = std::fabs(hp.value - hq.value);
  if (!(hp.error + hq.error <= kGoodEnough * rise) || !std::isfinite(rise)) return false;
  // Rounding can move t past an end by an ulp.
  t = std::clamp(hp.value / (hp.value - hq.value), 0.0, 1.0);
  return true;
}

/// Finds the point p + t (q - p). Returns false if a difference of coordinates overflows.
bool interpolate(const double* p, const double* q, double t, int dim, Eigen::Vector3d& r) {
  r.setZero();
  // Start from the nearer end, so that the result is as good near q as near p.
  for (int k = 0; k < dim; ++k) r[k] = t <= 0.5 ? p[k] + t * (q[k] - p[k]) : q[k] + (1 - t) * (p[k] - q[k]);
  return r.allFinite();
}

}  // namespace

Eigen::Vector3d cut_by_plane(const double* p, const double* q, const double* const t[3]) {
  double s = 0;
  Eigen::Vector3d r;
  // Fast path in doubles, then the exact path for nearly parallel segments and for overflow.
  if (parameter(volume(t[0], t[1], t[2], p), volume(t[0], t[1], t[2], q), s) && interpolate(p, q, s, 3, r))
    return r;
  const RationalVec rp = to_rational(p), rq = to_rational(q);
  const RationalVec a = to_rational(t[0]), b = to_rational(t[1]), c = to_rational(t[2]);
  const Rational hp = volume_determinant(a, b, c, rp), hq = volume_determinant(a, b, c, rq);
  return rounded(between(rp, rq, hp / (hp - hq)));
}

Eigen::Vector3d cut_by_line(const double* p, const double* q, const double* a, const double* b, int x, int y,
                            int dim) {
  double s = 0;
  Eigen::Vector3d r;
  // The same two paths with areas in place of volumes.
  if (parameter(area(a, b, p, x, y), area(a, b, q, x, y), s) && interpolate(p, q, s, dim, r)) return r;
  const RationalVec rp = to_rational(p, dim), rq = to_rational(q, dim);
  const RationalVec ra = to_rational(a, dim), rb = to_rational(b, dim);
  const Rational hp = area_determinant(ra, rb, rp, x, y), hq = area_determinant(ra, rb, rq, x, y);
  return rounded(between(rp, rq, hp / (hp - hq)));
}

}  // namespace lrb::exact
