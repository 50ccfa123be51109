#pragma once
/// Arithmetic with significands of 64 bits, the same bits with every processor and compiler.
///
/// IEEE 754 defines the results of +, -, *, / and square root, so x87's long double and the class below agree
/// on them. The functions use no others: sines and arc tangents of libraries differ, and those of x87's
/// instructions differ between processors.

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace lrb {

/// A number in software: 0, or significand 2^exponent with 2^63 <= |significand| < 2^64. There are no
/// infinities and no NaN. Exponents are not limited, so results are those of x87 unless it overflows or loses
/// bits below 2^-16382.
class SoftExtended {
  __extension__ using UInt128 = unsigned __int128;

 public:
  SoftExtended() = default;
  SoftExtended(int x)
      : SoftExtended(static_cast<double>(x)) {}  // NOLINT: implicit, like those of long double
  SoftExtended(double x) {                       // NOLINT
    negative_ = std::signbit(x);
    if (x == 0) return;
    int exponent;
    const double fraction = std::frexp(std::abs(x), &exponent);
    constexpr int kBits = 53;
    significand_ = static_cast<std::uint64_t>(std::ldexp(fraction, kBits)) << (64 - kBits);
    exponent_ = exponent - 64;
  }

  /// Rounds to nearest, ties to even, also below 2^-1022.
  explicit operator double() const {
    // Bits below the last one of the result.
    constexpr int kExcess = 11, kLeast = -1074;
    const int excess = std::max(kExcess, kLeast - exponent_);
    double magnitude = 0;
    if (significand_ != 0 && excess <= 64) {
      const std::uint64_t kept = excess < 64 ? significand_ >> excess : 0;
      const std::uint64_t rest = excess < 64 ? significand_ << (64 - excess) : significand_;
      constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;
      const bool up = rest > kHalf || (rest == kHalf && (kept & 1));
      magnitude = std::ldexp(static_cast<double>(kept + (up ? 1 : 0)), exponent_ + excess);
    }
    return negative_ ? -magnitude : magnitude;
  }

  SoftExtended operator-() const {
    SoftExtended r = *this;
    r.negative_ = !negative_;
    return r;
  }
  friend SoftExtended operator+(const SoftExtended& a, const SoftExtended& b) {
    if (a.significand_ == 0) return b.significand_ == 0 && !a.negative_ ? a : b;  // -0 only for -0 + -0
    if (b.significand_ == 0) return a;
    const bool swapped =
        a.exponent_ < b.exponent_ || (a.exponent_ == b.exponent_ && a.significand_ < b.significand_);
    const SoftExtended& x = swapped ? b : a;  // the larger one
    const SoftExtended& y = swapped ? a : b;
    // Align to x with 63 more bits; the last one represents all that are shifted out.
    const int shift = x.exponent_ - y.exponent_;
    constexpr int kMore = 63;
    const UInt128 high = UInt128{x.significand_} << kMore;
    UInt128 low = UInt128{y.significand_} << kMore;
    if (shift >= 127) {
      low = 1;
    } else if (shift > 0) {
      const bool lost = (low & ((UInt128{1} << shift) - 1)) != 0;
      low = low >> shift | (lost ? 1 : 0);
    }
    if (x.negative_ == y.negative_) return rounded(x.negative_, high + low, x.exponent_ - kMore);
    return rounded(x.negative_ && high != low, high - low, x.exponent_ - kMore);
  }
  friend SoftExtended operator-(const SoftExtended& a, const SoftExtended& b) { return a + -b; }
  friend SoftExtended operator*(const SoftExtended& a, const SoftExtended& b) {
    return rounded(a.negative_ != b.negative_, UInt128{a.significand_} * b.significand_,
                   a.exponent_ + b.exponent_);
  }
  friend SoftExtended operator/(const SoftExtended& a, const SoftExtended& b) {
    // At least 65 bits of the quotient, and one for the remainder.
    const UInt128 high = UInt128{a.significand_} << 62;
    const UInt128 first = high / b.significand_, rest = (high % b.significand_) << 4;
    const UInt128 quotient = first << 4 | rest / b.significand_;
    return rounded(a.negative_ != b.negative_, quotient << 1 | (rest % b.significand_ != 0 ? 1 : 0),
                   a.exponent_ - b.exponent_ - 67);
  }
  friend SoftExtended sqrt(const SoftExtended& x) {
    if (x.significand_ == 0) return x;
    // An even exponent, and a root of 64 bits.
    const int shift = x.exponent_ % 2 == 0 ? 64 : 63;
    const UInt128 square = UInt128{x.significand_} << shift;
    // One step of Newton's method from a root in double, correctly rounded on every processor, is at most 2
    // too large.
    UInt128 root = static_cast<UInt128>(std::sqrt(static_cast<double>(square)));
    root = (root + square / root) / 2;
    root = std::min(root, UInt128{~std::uint64_t{0}});
    while (root * root > square) --root;
    const UInt128 rest = square - root * root;  // (root + 1/2)^2 = root^2 + root + 1/4
    return rounded(false, root << 2 | (rest > root ? 3 : rest > 0 ? 1 : 0), (x.exponent_ - shift) / 2 - 2);
  }
  friend SoftExtended ldexp(SoftExtended x, int by) {
    x.exponent_ += by;
    return x;
  }
  friend SoftExtended abs(const SoftExtended& x) { return x.negative_ ? -x : x; }

  SoftExtended& operator+=(const SoftExtended& b) { return *this = *this + b; }
  SoftExtended& operator-=(const SoftExtended& b) { return *this = *this - b; }
  SoftExtended& operator*=(const SoftExtended& b) { return *this = *this * b; }
  SoftExtended& operator/=(const SoftExtended& b) { return *this = *this / b; }

  friend bool operator<(const SoftExtended& a, const SoftExtended& b) {
    const SoftExtended d = a - b;  // 0 only for equal numbers, because exponents are not limited
    return d.negative_ && d.significand_ != 0;
  }
  friend bool operator>(const SoftExtended& a, const SoftExtended& b) { return b < a; }
  friend bool operator<=(const SoftExtended& a, const SoftExtended& b) { return !(b < a); }
  friend bool operator>=(const SoftExtended& a, const SoftExtended& b) { return !(a < b); }
  friend bool operator==(const SoftExtended& a, const SoftExtended& b) { return !(a < b) && !(b < a); }

 private:
  /// Returns +-wide 2^exponent, rounded to nearest, ties to even. The last bit of `wide` may represent lost
  /// bits if there are two more than needed.
  static SoftExtended rounded(bool negative, UInt128 wide, int exponent) {
    SoftExtended r;
    r.negative_ = negative;
    if (wide == 0) return r;
    const auto top = static_cast<std::uint64_t>(wide >> 64);
    const int zeros =
        top != 0 ? std::countl_zero(top) : 64 + std::countl_zero(static_cast<std::uint64_t>(wide));
    wide <<= zeros;
    const auto low = static_cast<std::uint64_t>(wide);
    r.significand_ = static_cast<std::uint64_t>(wide >> 64);
    r.exponent_ = exponent - zeros + 64;
    constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;
    if ((low > kHalf || (low == kHalf && (r.significand_ & 1))) && ++r.significand_ == 0) {
      r.significand_ = kHalf;
      ++r.exponent_;
    }
    return r;
  }

  std::uint64_t significand_ = 0;
  int exponent_ = 0;
  bool negative_ = false;
};

// Windows starts threads with x87 set to 53 bits.
#if LDBL_MANT_DIG == 64 && !defined(_WIN32)
using Extended = long double;
#else
using Extended = SoftExtended;
#endif

namespace extended {

// Constants are unevaluated sums of doubles. Names of parts: the first has the leading bits.
inline constexpr double kHalfPi = 0x1.921fb54442d18p+0, kHalfPiRest = 0x1.1a62633145c07p-54;

template <class Real>
struct SineCosine {
  Real sine, cosine;
};

/// Returns x minus a multiple of 2 pi, rounded to 64 bits, for large |x|. All subtractions are exact, so the
/// error is at most |x| / 2^64.
template <class Real>
Real reduce_turns(const Real& x) {
  const Real turn = 4 * (Real(kHalfPi) + Real(kHalfPiRest));
  Real rest = x < 0 ? Real(-x) : x, multiple = turn;
  while (rest >= multiple) multiple *= 2;
  // Long division: rest < 2 multiple.
  while (multiple > turn) {
    multiple /= 2;
    if (rest >= multiple) rest -= multiple;
  }
  return x < 0 ? Real(-rest) : rest;
}

/// Returns sine and cosine to within 2^-63, relative to each if |x| < 2^31, otherwise plus |x| / 2^64.
template <class Real>
SineCosine<Real> sine_cosine(Real x) {
  // 1. Subtract the nearest multiple k of pi/2. The products of k and the first two parts are exact.
  constexpr double kPart[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69,
                              0x1.129024e088a68p-123};
  constexpr double kLarge = 2147483648.0, kTwoOverPi = 0x1.45f306dc9c883p-1;
  if (!(x < kLarge && x > -kLarge)) x = reduce_turns(x);
  const double k = std::floor(static_cast<double>(x) * kTwoOverPi + 0.5);
  const Real high = x - Real(k) * kPart[0], product = Real(k) * kPart[1];  // exact
  const Real first = high - product;
  // The rounding error of the last difference (Knuth's TwoSum), then the rest of the multiple.
  const Real back = first - high;
  const Real rest = ((high - (first - back)) - (product + back)) - Real(k) * kPart[2] - Real(k) * kPart[3];
  const Real r = first + rest, low = rest - (r - first);

  // 2. Taylor series on [-pi/4, pi/4], with the derivative times the low part. The first omitted terms are
  // below 2^-77.
  constexpr std::size_t kTerms = 10;
  struct Coefficients {
    std::array<Real, kTerms> sine, cosine;  // of z^i r^3 and z^(i+2): (-1)^i / n!
    Coefficients() {
      Real factorial = 2;
      for (std::size_t i = 0; i < kTerms; ++i) {
        const int sign = i % 2 == 0 ? 1 : -1, n = 2 * static_cast<int>(i) + 3;
        factorial *= n;
        sine[i] = Real(-sign) / factorial;
        factorial *= n + 1;
        cosine[i] = Real(sign) / factorial;
      }
    }
  };
  static const Coefficients c;
  const Real z = r * r;
  Real s = c.sine[kTerms - 1], t = c.cosine[kTerms - 1];
  for (std::size_t i = kTerms - 1; i-- > 0;) {
    s = s * z + c.sine[i];
    t = t * z + c.cosine[i];
  }
  const Real half = z / 2, one = 1 - half;
  const Real sine = r + (z * r * s + low * one);
  const Real cosine = one + (((1 - one) - half) + (z * z * t - r * low));

  // 3. Rotate by k right angles.
  switch (static_cast<long long>(k) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

/// Returns the angle of the vector (x, y), in [-pi, pi], to within 2^-62, relatively. x and y are not both 0.
template <class Real>
Real arc_tangent(const Real& y, const Real& x) {
  // 1. An angle of at most pi/4, in the first octant.
  const Real up = y < 0 ? Real(-y) : y, right = x < 0 ? Real(-x) : x;
  const bool steep = up > right;
  const Real& over = steep ? right : up;
  const Real& under = steep ? up : right;
  // 2. Subtract the arc tangent of the nearest eighth.
  constexpr double kArc[][2] = {{0, 0},
                                {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
  const int eighths = static_cast<int>(static_cast<double>(Real(over / under)) * 8 + 0.5);
  const Real near = Real(eighths) / 8;
  const Real u = (over - near * under) / (under + near * over);
  // 3. The series of |u| <= 1/16: u - u^3 / 3 + u^5 / 5 ... The first omitted term is below 2^-72 u.
  constexpr int kLast = 17;
  const Real z = u * u;
  Real sum = 0;
  for (int n = kLast; n >= 3; n -= 2) sum = (n % 4 == 1 ? 1 : -1) / Real(n) + z * sum;
  Real high = kArc[eighths][0], low = Real(kArc[eighths][1]) + (u + u * z * sum);
  // 4. Back to the octant: subtract from pi/2, then from pi.
  if (steep) {
    high = kHalfPi - high;
    low = kHalfPiRest - low;
  }
  if (x < 0) {
    high = 2 * kHalfPi - high;
    low = 2 * kHalfPiRest - low;
  }
  const Real angle = high + low;
  return y < 0 ? Real(-angle) : angle;
}

/// Returns base^x to within 2^-62, relatively, for |x| log2(base) < 16000, from log2(base), log(base) and
/// log_base(2), the last in a part of at most 48 bits and the rest.
template <class Real>
Real power(const Real& x, double log2_base, const std::array<double, 2>& log_base,
           const std::array<double, 3>& log_2) {
  using std::ldexp;
  // 1. base^x = 2^k exp(r): k is the integer nearest to x log2(base).
  const double k = std::floor(static_cast<double>(x) * log2_base + 0.5);
  const Real high =
      x - Real(k) * log_2[0];  // exact, or rounded relatively to x, which is smaller than log_base(2)
  const Real rest = high - Real(k) * log_2[1];
  const Real low = ((high - rest) - Real(k) * log_2[1]) - Real(k) * log_2[2];
  const Real r = rest * (Real(log_base[0]) + Real(log_base[1])) + low * log_base[0];
  // 2. Taylor series for |r| <= log(2) / 2. The first omitted term is below 2^-80.
  constexpr int kTerms = 17;
  static const std::array<Real, kTerms + 1> inverse_factorial = [] {
    std::array<Real, kTerms + 1> all;
    Real factorial = 1;
    for (int n = 0; n <= kTerms; ++n) {
      if (n > 1) factorial *= n;
      all[static_cast<std::size_t>(n)] = 1 / factorial;
    }
    return all;
  }();
  Real sum = inverse_factorial[kTerms];
  for (std::size_t n = kTerms; n-- > 2;) sum = sum * r + inverse_factorial[n];
  return ldexp(Real(1 + (r + r * r * sum)), static_cast<int>(k));
}

/// Returns the rotation about a unit vector by an angle (Rodrigues' formula).
template <class Real>
Eigen::Matrix<Real, 3, 3> rotation(const Eigen::Matrix<Real, 3, 1>& axis, const Real& angle) {
  const auto [sine, c] = sine_cosine(angle);
  const Eigen::Matrix<Real, 3, 1> across = sine * axis, along = (1 - c) * axis;
  Eigen::Matrix<Real, 3, 3> r;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    r(i, i) = along[i] * axis[i] + c;
    const Real product = along[std::min(i, j)] * axis[std::max(i, j)];
    r(i, j) = product - across[k];
    r(j, i) = product + across[k];
  }
  return r;
}

}  // namespace extended
}  // namespace lrb

namespace Eigen {

template <>
struct NumTraits<lrb::SoftExtended> : GenericNumTraits<lrb::SoftExtended> {
  using Real = lrb::SoftExtended;
  using NonInteger = lrb::SoftExtended;
  using Nested = lrb::SoftExtended;
  using Literal = double;
  static Real epsilon() { return std::ldexp(1.0, -63); }
  static Real dummy_precision() { return 1e-15; }
  enum {
    IsInteger = 0,
    IsSigned = 1,
    IsComplex = 0,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 20,
    MulCost = 20
  };
};

}  // namespace Eigen
