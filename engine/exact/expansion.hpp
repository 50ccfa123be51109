#pragma once
/// Floating-point expansions: numbers held exactly as sums of doubles of increasing magnitude that do not
/// overlap (no two have a bit of the same weight), with zeros left out. After Dekker (1971) and Shewchuk,
/// "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates" (1997), of which only
/// the theorems are used.
///
/// Everything here is exact as long as no operation overflows and no error term falls below 2^-1074. For sums
/// of products of k factors this holds if each factor is 0 or has a magnitude in [2^-lo, 2^hi] with k * (lo +
/// 53) <= 1074 and k * (hi + 1) + 30 <= 1023 (the 30 is for Dekker's split and the length of the sum).
/// Arithmetic must be binary64, round to nearest even, without contraction.

#include <array>
#include <cfloat>
#include <cmath>

namespace lrb::exact {

static_assert(FLT_EVAL_METHOD == 0, "expansions need arithmetic rounded to double after each operation");

/// Sets x = fl(a + b) and y to what was rounded away: x + y = a + b exactly. For any a, b whose sum does not
/// overflow.
inline void two_sum(double a, double b, double& x, double& y) {
  x = a + b;
  const double b_virtual = x - a;
  const double a_virtual = x - b_virtual;
  y = (a - a_virtual) + (b - b_virtual);
}

/// Does the same if |a| >= |b| (or a = 0 = b).
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
#ifdef __FMA__
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
  /// Returns the value to within one unit in the last place: adds the components from the smallest up.
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
    double high, middle;
    two_product(e[i], b, high, low);
    two_sum(q, low, middle, low);
    r.append(low);
    fast_two_sum(high, middle, q, low);
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

/// Returns e * f for a short f, exactly.
template <int M>
Expansion<4 * M> product(const Expansion<M>& e, const Expansion<2>& f) {
  if (f.size == 2) return sum(scale(e, f[0]), scale(e, f[1]));
  Expansion<4 * M> r;
  if (f.size == 0) return r;
  const Expansion<2 * M> p = scale(e, f[0]);
  for (int i = 0; i < p.size; ++i) r.append(p[i]);
  return r;
}

}  // namespace lrb::exact
