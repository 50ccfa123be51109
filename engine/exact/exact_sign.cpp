#include "engine/exact/exact_sign.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <boost/multiprecision/cpp_int.hpp>

#include "engine/exact/expansion.hpp"
#include "engine/exact/simplex_test.hpp"

namespace lrb::exact {
namespace {

using boost::multiprecision::cpp_int;

thread_local std::uint64_t fallback_count = 0;

// A coordinate is either 0 or has a magnitude in [2^-300, 2^300]: then for products of up to three factors
// expansion.hpp's conditions hold: 3 * (300 + 53) = 1059 <= 1074 and 3 * 301 + 30 = 933 <= 1023.
constexpr double kSmallest = 0x1p-300;
constexpr double kLargest = 0x1p+300;

bool in_range(double x) {
  const double m = std::fabs(x);
  return m <= kLargest && (m >= kSmallest || m == 0);
}

/// Coordinates of up to four points along one axis as integers: multiplied by a common power of two, which
/// changes no sign of a determinant.
template <std::size_t N>
std::array<cpp_int, N> scaled_to_integers(const std::array<double, N>& x) {
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
  std::array<cpp_int, N> r;
  for (std::size_t i = 0; i < N; ++i) {
    r[i] = mantissa[i];
    if (mantissa[i] != 0) r[i] <<= exponent[i] - least;
  }
  return r;
}

int orient2d_integer(const double* a, const double* b, const double* c, int x, int y) {
  const auto px = scaled_to_integers<3>({a[x], b[x], c[x]});
  const auto py = scaled_to_integers<3>({a[y], b[y], c[y]});
  const cpp_int left = (px[1] - px[0]) * (py[2] - py[0]);
  const cpp_int right = (py[1] - py[0]) * (px[2] - px[0]);
  return left.compare(right);
}

int orient3d_integer(const double* a, const double* b, const double* c, const double* d) {
  std::array<std::array<cpp_int, 3>, 3> m;  // rows b - a, c - a, d - a
  for (std::size_t k = 0; k < 3; ++k) {
    const auto p = scaled_to_integers<4>({a[k], b[k], c[k], d[k]});
    for (std::size_t i = 0; i < 3; ++i) m[i][k] = p[i + 1] - p[0];
  }
  const cpp_int nx = m[0][1] * m[1][2] - m[0][2] * m[1][1];
  const cpp_int ny = m[0][2] * m[1][0] - m[0][0] * m[1][2];
  const cpp_int nz = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const cpp_int det = nx * m[2][0] + ny * m[2][1] + nz * m[2][2];
  return det.sign();
}

int sign_of(int comparison) {
  return (comparison > 0) - (comparison < 0);
}

/// u0 * v1 - u1 * v0.
Expansion<16> minor(const Expansion<2>& u0, const Expansion<2>& u1, const Expansion<2>& v0,
                    const Expansion<2>& v1) {
  return sum(product(u0, v1), product(-u1, v0));
}

}  // namespace

std::uint64_t exact_fallbacks() {
  return fallback_count;
}

int orient2d_exact(const double* a, const double* b, const double* c, int x, int y) {
  // Points with equal coordinates on one axis, or points that coincide.
  if (a[x] == b[x] && a[x] == c[x]) return 0;
  if (a[y] == b[y] && a[y] == c[y]) return 0;
  if ((a[x] == b[x] && a[y] == b[y]) || (b[x] == c[x] && b[y] == c[y]) || (a[x] == c[x] && a[y] == c[y]))
    return 0;
  ++fallback_count;
  const bool safe = in_range(a[x]) && in_range(b[x]) && in_range(c[x]) && in_range(a[y]) && in_range(b[y]) &&
                    in_range(c[y]);
  if (!safe) return sign_of(orient2d_integer(a, b, c, x, y));
  return minor(difference(b[x], a[x]), difference(b[y], a[y]), difference(c[x], a[x]), difference(c[y], a[y]))
      .sign();
}

int orient3d_exact(const double* a, const double* b, const double* c, const double* d) {
  for (int k = 0; k < 3; ++k) {
    if (a[k] == b[k] && a[k] == c[k] && a[k] == d[k]) return 0;
  }
  if (same_point(a, d) || same_point(b, d) || same_point(c, d)) return 0;
  if (same_point(a, b) || same_point(b, c) || same_point(a, c)) return 0;
  ++fallback_count;
  for (int k = 0; k < 3; ++k) {
    if (!(in_range(a[k]) && in_range(b[k]) && in_range(c[k]) && in_range(d[k])))
      return orient3d_integer(a, b, c, d);
  }
  std::array<Expansion<2>, 3> u, v, w;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    u[i] = difference(b[k], a[k]);
    v[i] = difference(c[k], a[k]);
    w[i] = difference(d[k], a[k]);
  }
  const auto x = product(minor(u[1], u[2], v[1], v[2]), w[0]);
  const auto y = product(minor(u[2], u[0], v[2], v[0]), w[1]);
  const auto z = product(minor(u[0], u[1], v[0], v[1]), w[2]);
  return sum(sum(x, y), z).sign();
}

}  // namespace lrb::exact
