#pragma once
/// Rational coordinates. Private to engine/exact, because it includes Boost.

#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <boost/multiprecision/cpp_int.hpp>

#include "engine/exact/locate.hpp"

namespace lrb::exact {

using Rational = boost::multiprecision::cpp_rational;
/// Values, so that no expression template refers to a destroyed temporary.
using RationalVec = std::array<Rational, 3>;

/// Returns the double's exact value.
inline Rational to_rational(double x) {
  constexpr int kMantissaBits = 53;
  int exponent = 0;
  const double mantissa = std::ldexp(std::frexp(x, &exponent), kMantissaBits);
  boost::multiprecision::cpp_int n = static_cast<std::int64_t>(mantissa);
  boost::multiprecision::cpp_int d = 1;
  const int shift = exponent - kMantissaBits;
  if (shift >= 0) {
    n <<= shift;
  } else {
    d <<= -shift;
  }
  return Rational(n, d);
}

inline RationalVec to_rational(const double* p, int dim = 3) {
  RationalVec r;
  for (int k = 0; k < dim; ++k) r[static_cast<std::size_t>(k)] = to_rational(p[k]);
  return r;
}

inline Eigen::Vector3d rounded(const RationalVec& p) {
  return {p[0].convert_to<double>(), p[1].convert_to<double>(), p[2].convert_to<double>()};
}

/// Returns a + t (b - a).
inline RationalVec between(const RationalVec& a, const RationalVec& b, const Rational& t) {
  RationalVec r;
  for (std::size_t k = 0; k < 3; ++k) r[k] = a[k] + t * (b[k] - a[k]);
  return r;
}

/// Returns (b - a) x (c - a) in the coordinates x and y: the determinant of orient2d. Number: Rational, or an
/// integer that can hold the terms.
template <class Number>
Number area_determinant(const std::array<Number, 3>& a, const std::array<Number, 3>& b,
                        const std::array<Number, 3>& c, int x, int y) {
  const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
  return (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
}

/// Returns det[b - a; c - a; d - a]: the determinant of orient3d.
template <class Number>
Number volume_determinant(const std::array<Number, 3>& a, const std::array<Number, 3>& b,
                          const std::array<Number, 3>& c, const std::array<Number, 3>& d) {
  return area_determinant(a, b, c, 1, 2) * (d[0] - a[0]) + area_determinant(a, b, c, 2, 0) * (d[1] - a[1]) +
         area_determinant(a, b, c, 0, 1) * (d[2] - a[2]);
}

// Exact clipping of a segment by linear conditions.

/// A part of a segment, as an interval of its parameter in [0, 1].
struct RationalInterval {
  Rational low = 0, high = 1;
  bool empty = false;

  /// Keeps the part where f >= 0. f is linear along the segment and given by its values at both ends.
  void keep_positive(const Rational& at_start, const Rational& at_end) {
    if (at_start < 0 && at_end < 0) empty = true;
    if (empty || (at_start >= 0 && at_end >= 0)) return;
    const Rational t = at_start / (at_start - at_end);
    if (at_start < 0 && t > low) low = t;
    if (at_end < 0 && t < high) high = t;
    empty = low > high;
  }
  /// Keeps the part where f = 0.
  void keep_zero(const Rational& at_start, const Rational& at_end) {
    keep_positive(at_start, at_end);
    keep_positive(-at_start, -at_end);
  }
};

// The contents of a RationalPoint.

struct RationalPoint::Coordinates {
  RationalVec x;
  std::array<double, 3> low, high;  ///< doubles that enclose x; equal if x is a double

  explicit Coordinates(RationalVec coordinates);
};

inline RationalPoint make_point(RationalVec x) {
  return RationalPoint(std::make_shared<const RationalPoint::Coordinates>(std::move(x)));
}

}  // namespace lrb::exact
