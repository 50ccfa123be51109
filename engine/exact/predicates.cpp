#include "engine/exact/predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/multiprecision/cpp_int.hpp>

#include "engine/exact/expansion.hpp"
#include "engine/exact/plane_side.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::exact {

int orient2d(const double* a, const double* b, const double* c) {
  return orient_axes(a, b, c, 0, 1);
}

int orient3d(const double* a, const double* b, const double* c, const double* d) {
  return PlaneSide(a, b, c).side(d);
}

bool collinear3d(const double* a, const double* b, const double* c) {
  return orient_axes(a, b, c, 0, 1) == 0 && orient_axes(a, b, c, 1, 2) == 0 &&
         orient_axes(a, b, c, 2, 0) == 0;
}

// Exact signs of orient2d and orient3d, for points on which the floating-point filter cannot decide.
// 0. Return 0 for coincident points and axis-aligned planes, without arithmetic.
// 1. 64-bit fixed point (expansion.hpp), if the coordinates on each axis span fewer than 62 bits.
// 2. Floating-point expansions (Shewchuk 1997), if no product can overflow or underflow.
// 3. Long integers, for all finite doubles.
// Steps 1 and 3 scale each axis by its own power of two, which changes no sign of a determinant.

namespace {

using boost::multiprecision::cpp_int;

thread_local std::uint64_t fallback_count = 0;
thread_local bool floating_only = false;

int sign(double x) {
  return (x > 0) - (x < 0);
}

int orient2d_floating(const double* a, const double* b, const double* c, int x, int y) {
  return sign((b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]));
}

int orient3d_floating(const double* a, const double* b, const double* c, const double* d) {
  double u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
    w[k] = d[k] - a[k];
  }
  return sign((u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
              (u[0] * v[1] - u[1] * v[0]) * w[2]);
}

// Expansions apply if every coordinate is 0 or has a magnitude in [2^-300, 2^300]: then expansion.hpp's
// conditions hold for products of up to three factors: 3 * (300 + 53) = 1059 <= 1074 and 3 * 301 + 30 = 933
// <= 1023.
constexpr double kSmallest = 0x1p-300;
constexpr double kLargest = 0x1p+300;

template <std::size_t N>
bool all_in_range(const std::array<double, N>& x) {
  return std::all_of(x.begin(), x.end(), [](double v) {
    const double m = std::fabs(v);
    return m <= kLargest && (m >= kSmallest || m == 0);
  });
}

/// Returns the coordinates of up to four points along one axis as integers: multiplied by a common power of
/// two, which does not change the sign of a determinant.
template <std::size_t N>
std::array<cpp_int, N> scaled_to_integers(const std::array<double, N>& x) {
  // Pass 1: write each coordinate as a 53-bit integer times a power of two, and find the least exponent.
  constexpr int kMantissaBits = 53;
  std::array<std::int64_t, N> mantissa{};
  std::array<int, N> exponent{};
  int least = 0;
  bool any = false;
  for (std::size_t i = 0; i < N; ++i) {
    int e = 0;
    mantissa[i] = static_cast<std::int64_t>(std::ldexp(std::frexp(x[i], &e), kMantissaBits));
    exponent[i] = e;
    if (mantissa[i] == 0) continue;
    least = any ? std::min(least, e) : e;
    any = true;
  }
  // Pass 2: shift all to that exponent. The range of doubles bounds the result by about 2,150 bits.
  std::array<cpp_int, N> r;
  for (std::size_t i = 0; i < N; ++i) {
    r[i] = mantissa[i];
    if (mantissa[i] != 0) r[i] <<= exponent[i] - least;
  }
  return r;
}

int orient2d_integer(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  const auto px = scaled_to_integers(x);
  const auto py = scaled_to_integers(y);
  // The determinant is left - right. Comparing the products saves the subtraction.
  const cpp_int left = (px[1] - px[0]) * (py[2] - py[0]);
  const cpp_int right = (py[1] - py[0]) * (px[2] - px[0]);
  return (left > right) - (left < right);
}

/// Returns u0 * v1 - u1 * v0.
Expansion<16> minor(const Expansion<2>& u0, const Expansion<2>& u1, const Expansion<2>& v0,
                    const Expansion<2>& v1) {
  return sum(product(u0, v1), product(-u1, v0));
}

}  // namespace

int orient3d_integer(const Coordinates4& x) {
  std::array<std::array<cpp_int, 3>, 3> m;  // rows b - a, c - a, d - a
  for (std::size_t k = 0; k < 3; ++k) {
    const auto p = scaled_to_integers(x[k]);
    for (std::size_t i = 0; i < 3; ++i) m[i][k] = p[i + 1] - p[0];
  }
  // Expand the determinant along its last row: the normal of (a, b, c), times d - a.
  const cpp_int nx = m[0][1] * m[1][2] - m[0][2] * m[1][1];
  const cpp_int ny = m[0][2] * m[1][0] - m[0][0] * m[1][2];
  const cpp_int nz = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const cpp_int det = nx * m[2][0] + ny * m[2][1] + nz * m[2][2];
  return det.sign();
}

bool expansions_apply(const Coordinates4& p) {
  return all_in_range(p[0]) && all_in_range(p[1]) && all_in_range(p[2]);
}

int orient3d_expansion(const Coordinates4& p) {
  // Each difference of two doubles is a sum of two doubles, exactly (Knuth's two-sum).
  std::array<Expansion<2>, 3> u, v, w;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = difference(p[k][1], p[k][0]);
    v[k] = difference(p[k][2], p[k][0]);
    w[k] = difference(p[k][3], p[k][0]);
  }
  // Cofactors of the last row. A minor has at most 16 components, a product 64, the sum of all three 192.
  const auto x = product(minor(u[1], u[2], v[1], v[2]), w[0]);
  const auto y = product(minor(u[2], u[0], v[2], v[0]), w[1]);
  const auto z = product(minor(u[0], u[1], v[0], v[1]), w[2]);
  return sum(sum(x, y), z).sign();
}

FloatingPredicates::FloatingPredicates(bool on) : before_(floating_only) {
  floating_only = on;
}

FloatingPredicates::~FloatingPredicates() {
  floating_only = before_;
}

bool only_floating() {
  return floating_only;
}

std::uint64_t exact_fallbacks() {
  return fallback_count;
}

int orient2d_exact(const double* a, const double* b, const double* c, int x, int y) {
  if (floating_only) return orient2d_floating(a, b, c, x, y);
  // Equal coordinates on one axis, or coincident points: collinear.
  if (a[x] == b[x] && a[x] == c[x]) return 0;
  if (a[y] == b[y] && a[y] == c[y]) return 0;
  if ((a[x] == b[x] && a[y] == b[y]) || (b[x] == c[x] && b[y] == c[y]) || (a[x] == c[x] && a[y] == c[y]))
    return 0;
  ++fallback_count;
  const std::array<double, 3> px{a[x], b[x], c[x]}, py{a[y], b[y], c[y]};
  std::array<std::int64_t, 3> fx, fy;
  // Fastest method first. The order affects the running time only: every method is exact where it applies.
  if (to_fixed_point(px, fx) && to_fixed_point(py, fy)) return orient2d_fixed(fx, fy);
  if (!all_in_range(px) || !all_in_range(py)) return orient2d_integer(px, py);
  return minor(difference(px[1], px[0]), difference(py[1], py[0]), difference(px[2], px[0]),
               difference(py[2], py[0]))
      .sign();
}

int orient3d_exact(const double* a, const double* b, const double* c, const double* d) {
  if (floating_only) return orient3d_floating(a, b, c, d);
  // All four points in a plane perpendicular to an axis: coplanar.
  for (int k = 0; k < 3; ++k) {
    if (a[k] == b[k] && a[k] == c[k] && a[k] == d[k]) return 0;
  }
  // Two coincident points leave at most three distinct ones, which are coplanar.
  if (same_point(a, d) || same_point(b, d) || same_point(c, d)) return 0;
  if (same_point(a, b) || same_point(b, c) || same_point(a, c)) return 0;
  ++fallback_count;
  Coordinates4 p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = {a[k], b[k], c[k], d[k]};
  std::array<std::array<std::int64_t, 4>, 3> f;
  if (to_fixed_point(p[0], f[0]) && to_fixed_point(p[1], f[1]) && to_fixed_point(p[2], f[2]))
    return orient3d_fixed(f);
  return expansions_apply(p) ? orient3d_expansion(p) : orient3d_integer(p);
}

}  // namespace lrb::exact
