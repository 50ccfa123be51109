#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>

namespace lrb {

/// SplitMix64 (Steele, Lea and Flood 2014). A seed gives the same numbers on every machine and with every
/// standard library, unlike the distributions of the standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Returns 64 random bits.
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Returns a uniformly distributed number in [least, most).
  double in(double least, double most) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53: a double has 53 bits
    return least + (most - least) * static_cast<double>(bits() >> 11) * kUnit;
  }
  /// Returns a number in 0 .. bound - 1 (bound > 0), uniformly distributed to within 2^-32.
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((bits() >> 32) * bound) >> 32);
  }
  /// Permutes the elements randomly.
  template <class Vector>
  void shuffle(Vector& elements) {
    for (auto i = static_cast<std::uint32_t>(elements.size()); i > 1; --i)
      std::swap(elements[i - 1], elements[below(i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace lrb

namespace lrb::deterministic {

// Mathematical functions with the same result on every x86-64 processor.
//
// glibc selects the code of sin, cos, exp and others for double by processor, with or without fused
// multiply-add. The results occasionally differ in the last bit, which is enough to change a body and thus a
// run. The functions for long double have the same code everywhere. Rounded to double, their results are
// correctly rounded, except for about one in two thousand. Verified by running the goldens with
// GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2.

inline double sin(double x) {
  return static_cast<double>(std::sin(static_cast<long double>(x)));
}
inline double cos(double x) {
  return static_cast<double>(std::cos(static_cast<long double>(x)));
}
inline double exp(double x) {
  return static_cast<double>(std::exp(static_cast<long double>(x)));
}
inline double exp2(double x) {
  return static_cast<double>(std::exp2(static_cast<long double>(x)));
}
inline double pow10(double x) {
  return static_cast<double>(std::pow(10.0L, static_cast<long double>(x)));
}
inline double tan(double x) {
  return static_cast<double>(std::tan(static_cast<long double>(x)));
}
inline double atan(double x) {
  return static_cast<double>(std::atan(static_cast<long double>(x)));
}
inline double acos(double x) {
  return static_cast<double>(std::acos(static_cast<long double>(x)));
}
inline double atan2(double y, double x) {
  return static_cast<double>(std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
}

/// Returns the rotation about a unit vector by an angle in radians.
inline Eigen::Matrix3d rotation(const Eigen::Vector3d& axis, double angle) {
  using Turn = Eigen::AngleAxis<long double>;
  return Turn(angle, axis.cast<long double>()).toRotationMatrix().cast<double>();
}

/// Returns the smallest rotation that maps one vector's direction to another's; neither may be 0.
/// Equal to Eigen's FromTwoVectors() unless they are opposite, without the singular value decomposition that
/// takes seconds to compile.
inline Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double c = b.dot(a);
  Eigen::Quaterniond q;
  if (c < -1 + Eigen::NumTraits<double>::dummy_precision()) {
    q.vec() = a.unitOrthogonal();
    q.w() = 0;
    return q;
  }
  const double s = std::sqrt((1 + c) * 2);
  q.vec() = a.cross(b) * (1 / s);
  q.w() = s * 0.5;
  return q;
}

}  // namespace lrb::deterministic
