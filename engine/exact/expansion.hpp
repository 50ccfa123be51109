#pragma once
/// Floating-point expansions: exact numbers represented as sums of non-overlapping doubles of increasing
/// magnitude (no two have a bit of the same weight), with zeros omitted. After Dekker (1971) and Shewchuk,
/// "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates" (1997); only the
/// theorems are used.
///
/// All operations are exact as long as none overflows and no error term falls below 2^-1074. For sums of
/// products of k factors this holds if each factor is 0 or has a magnitude in [2^-lo, 2^hi] with k * (lo +
/// 53) <= 1074 and k * (hi + 1) + 30 <= 1023 (30: for Dekker's split and the length of the sum). Arithmetic
/// must be binary64, round to nearest even, without contraction.

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lrb::exact {

static_assert(FLT_EVAL_METHOD == 0, "expansions need arithmetic rounded to double after each operation");

/// Sets x = fl(a + b) and y to the rounding error, so that x + y = a + b exactly (Knuth's TwoSum). For any a,
/// b whose sum does not overflow.
inline void two_sum(double a, double b, double& x, double& y) {
  x = a + b;
  const double b_virtual = x - a;
  const double a_virtual = x - b_virtual;
  y = (a - a_virtual) + (b - b_virtual);
}

/// Sets x and y as two_sum() does (Dekker's FastTwoSum). Requires |a| >= |b|, or a = b = 0.
inline void fast_two_sum(double a, double b, double& x, double& y) {
  x = a + b;
  y = b - (x - a);
}

/// Sets x = fl(a - b) and y such that x + y = a - b exactly.
inline void two_difference(double a, double b, double& x, double& y) {
  two_sum(a, -b, x, y);
}

/// Sets x = fl(a * b) and y such that x + y = a * b exactly.
inline void two_product(double a, double b, double& x, double& y) {
  x = a * b;
#if defined(__FMA__) || defined(__aarch64__)
  y = std::fma(a, b, -x);
#else
  // Dekker: split both into halves of at most 26 bits, whose products are exact.
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const double ca = kSplitter * a;
  const double a_high = ca - (ca - a);
  const double a_low = a - a_high;
  const double cb = kSplitter * b;
  const double b_high = cb - (cb - b);
  const double b_low = b - b_high;
  y = a_low * b_low - (((x - a_high * b_high) - a_low * b_high) - a_high * b_low);
#endif
}

/// An expansion of at most Capacity components. Components beyond `size` are uninitialised.
template <int Capacity>
struct Expansion {
  std::array<double, Capacity> component;
  int size = 0;

  Expansion() {}  // components stay uninitialised: clearing them would cost more than the arithmetic

  void append(double x) {
    if (x != 0) component[static_cast<std::size_t>(size++)] = x;
  }
  double operator[](int i) const { return component[static_cast<std::size_t>(i)]; }
  int sign() const {
    if (size == 0) return 0;
    return component[static_cast<std::size_t>(size - 1)] > 0 ? 1 : -1;
  }
  /// Returns the value to within one unit in the last place: adds the components in ascending order.
  double estimate() const {
    double sum = 0;
    for (int i = 0; i < size; ++i) sum += (*this)[i];
    return sum;
  }
  Expansion operator-() const {
    Expansion r;
    r.size = size;
    for (int i = 0; i < size; ++i) r.component[static_cast<std::size_t>(i)] = -(*this)[i];
    return r;
  }
};

/// Returns a - b, exactly.
inline Expansion<2> difference(double a, double b) {
  Expansion<2> r;
  double x, y;
  two_difference(a, b, x, y);
  r.append(y);
  r.append(x);
  return r;
}

/// Returns e * b, exactly (Shewchuk's theorem 19: non-overlapping in, non-overlapping out).
template <int N>
Expansion<2 * N> scale(const Expansion<N>& e, double b) {
  Expansion<2 * N> r;
  if (e.size == 0 || b == 0) return r;
  double q, low;
  two_product(e[0], b, q, low);
  r.append(low);
  for (int i = 1; i < e.size; ++i) {
    double high, mid;
    two_product(e[i], b, high, low);
    two_sum(q, low, mid, low);
    r.append(low);
    fast_two_sum(high, mid, q, low);
    r.append(low);
  }
  r.append(q);
  return r;
}

/// Returns e + f, exactly, in linear time (Shewchuk's linear expansion sum, which only requires that the
/// components of each input do not overlap).
template <int M, int N>
Expansion<M + N> sum(const Expansion<M>& e, const Expansion<N>& f) {
  Expansion<M + N> r;
  int i = 0, j = 0;
  const auto next_smallest = [&] {
    if (j >= f.size || (i < e.size && std::fabs(e[i]) <= std::fabs(f[j]))) return e[i++];
    return f[j++];
  };
  const int total = e.size + f.size;
  if (total == 0) return r;
  double q_high = next_smallest(), q_low = 0;
  if (total > 1) {
    const double g = next_smallest();
    fast_two_sum(g, q_high, q_high, q_low);
  }
  for (int k = 2; k < total; ++k) {
    double r_high, done;
    fast_two_sum(next_smallest(), q_low, r_high, done);
    r.append(done);
    two_sum(q_high, r_high, q_high, q_low);
  }
  r.append(q_low);
  r.append(q_high);
  return r;
}

/// Returns e * f exactly, for an f of at most two components.
template <int M>
Expansion<4 * M> product(const Expansion<M>& e, const Expansion<2>& f) {
  if (f.size == 2) return sum(scale(e, f[0]), scale(e, f[1]));
  Expansion<4 * M> r;
  if (f.size == 0) return r;
  const Expansion<2 * M> p = scale(e, f[0]);
  for (int i = 0; i < p.size; ++i) r.append(p[i]);
  return r;
}

// Determinants in 64-bit fixed point: exact, almost branch-free, and about ten times faster than expansions.
// For points whose coordinates share an exponent range, which is true for nearly all neighbouring faces.

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

/// Converts the coordinates of N points along one axis to integers below 2^62 in magnitude, by multiplication
/// by a common power of two, which does not change the sign of a determinant. Returns false if they do not
/// fit: if the highest and the lowest bit set in any of them are 62 or more positions apart, or one of them
/// is (almost) denormal.
template <std::size_t N>
bool to_fixed_point(const std::array<double, N>& x, std::array<std::int64_t, N>& r) {
  constexpr int kMantissaBits = 52, kExponentBias = 1023, kExponentMask = 2047;
  constexpr int kNone = 4096;
  int highest = 0, lowest = kNone;  // biased exponents of the bits
  for (double v : x) {
    const auto bits = std::bit_cast<std::uint64_t>(v);
    const int exponent = static_cast<int>(bits >> kMantissaBits) & kExponentMask;
    const int low = exponent - kMantissaBits + std::countr_zero(bits | (std::uint64_t{1} << kMantissaBits));
    highest = std::max(highest, exponent);
    lowest = std::min(lowest, v == 0 ? kNone : low);
  }
  // The factor 2^-lowest must be a normal double.
  if (highest - lowest >= 62 || lowest < 1 || lowest >= 2 * kExponentBias) return false;
  const auto scale =
      std::bit_cast<double>(static_cast<std::uint64_t>(2 * kExponentBias - lowest) << kMantissaBits);
  for (std::size_t i = 0; i < N; ++i) r[i] = static_cast<std::int64_t>(x[i] * scale);
  return true;
}

/// Returns the sign of (b - a) x (c - a) in the given coordinates. These are below 2^62, so differences are
/// below 2^63 and products below 2^126.
inline int orient2d_fixed(const std::array<std::int64_t, 3>& x, const std::array<std::int64_t, 3>& y) {
  const Int128 left = Int128{x[1] - x[0]} * (y[2] - y[0]);
  const Int128 right = Int128{y[1] - y[0]} * (x[2] - x[0]);
  return (left > right) - (left < right);
}

/// Returns the sign of det[b - a; c - a; d - a]; p[k] contains the points' coordinates on axis k.
inline int orient3d_fixed(const std::array<std::array<std::int64_t, 4>, 3>& p) {
  std::array<std::int64_t, 3> u, v, w;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = p[k][1] - p[k][0];
    v[k] = p[k][2] - p[k][0];
    w[k] = p[k][3] - p[k][0];
  }
  // The determinant is at most twice the volume of the points' box, hence below 2^190, and is represented as
  // high * 2^64 + low, where high fits 128 bits. Partial sums of high may wrap, hence unsigned.
  UInt128 high = 0, low = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const Int128 minor = Int128{u[i]} * v[j] - Int128{u[j]} * v[i];
    const Int128 upper = Int128{static_cast<std::int64_t>(minor >> 64)} * w[k];
    const Int128 lower = Int128{static_cast<std::uint64_t>(minor)} * w[k];
    high += static_cast<UInt128>(upper) + static_cast<UInt128>(lower >> 64);
    low += static_cast<std::uint64_t>(lower);
  }
  high += low >> 64;
  const auto signed_high = static_cast<Int128>(high);
  if (signed_high != 0) return signed_high < 0 ? -1 : 1;
  return static_cast<std::uint64_t>(low) != 0 ? 1 : 0;
}

}  // namespace lrb::exact
