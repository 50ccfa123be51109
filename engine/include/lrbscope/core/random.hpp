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

// Mathematical functions with the same result on every processor and with every compiler.
//
// Those of standard libraries differ in the last bit, between libraries and, if they select code with or
// without fused multiply-add, between processors, which is enough to change a body and thus a run. These are
// computed with significands of 64 bits (engine/core/extended.hpp) and rounded to double. The results are
// correctly rounded, except for about one in two thousand. Arguments that are not finite result in NaN.

double sin(double x);
double cos(double x);
double tan(double x);
double atan(double x);
double acos(double x);
double atan2(double y, double x);
double exp(double x);
double exp2(double x);
double pow10(double x);

/// Returns a vector times the power of two that brings its largest coordinate into [1/2, 1), so that its
/// squares neither overflow nor underflow; 0 remains 0. The direction is the same: normalized() returns the
/// same bits, if it does not overflow or underflow without this.
inline Eigen::Vector3d scaled_direction(const Eigen::Vector3d& v) {
  int exponent = 0;
  std::frexp(v.cwiseAbs().maxCoeff(), &exponent);
  return v.unaryExpr([exponent](double x) { return std::ldexp(x, -exponent); });
}

/// Returns the rotation about a unit vector by an angle in radians.
Eigen::Matrix3d rotation(const Eigen::Vector3d& axis, double angle);

/// Returns the rotation at t in [0, 1] between two, each about a unit vector by an angle in radians, with a
/// constant axis and angular velocity in between (slerp).
Eigen::Matrix3d rotation_between(const Eigen::Vector3d& axis_0, double angle_0, const Eigen::Vector3d& axis_1,
                                 double angle_1, double t);

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
