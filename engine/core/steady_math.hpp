#pragma once
/// Functions that give the same double on every x86-64 processor.
///
/// glibc's sin, cos, exp and others for double pick their code by processor, with or without fused
/// multiply-add, and the results differ in the last bit here and there: enough to make a different body, and
/// so a different run. The functions for long double have the same code everywhere. Rounded to double, their
/// results are the correctly rounded ones, but for about one in two thousand. Checked by running the goldens
/// with GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2.

#include <cmath>

#include <Eigen/Geometry>

namespace lrb::steady {

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

/// Returns the smallest turn that brings the direction of one vector to that of another; neither may be 0.
/// The same as Eigen's FromTwoVectors() unless they are opposite, without the singular values for which the
/// compiler takes seconds.
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

}  // namespace lrb::steady
