#include <limits>

#include <Eigen/Geometry>

#include "engine/core/extended.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/core/random.hpp>

namespace lrb::deterministic {
namespace {

using Vector = Eigen::Matrix<Extended, 3, 1>;
using Quaternion = Eigen::Quaternion<Extended>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

extended::SineCosine<Extended> sine_cosine(double x) {
  return extended::sine_cosine<Extended>(x);
}

/// Calls power(x) unless the result is 0 or infinite.
template <class Power>
double power_in_range(double x, double log2_base, Power&& power) {
  constexpr double kMax = 1100;
  const double exponent = x * log2_base;
  if (!(exponent < kMax)) return exponent + std::numeric_limits<double>::infinity();  // NaN: NaN
  return exponent > -kMax ? static_cast<double>(power(Extended(x))) : 0;
}

Quaternion quaternion(const Eigen::Vector3d& axis, double angle) {
  const auto [sine, cosine] = extended::sine_cosine<Extended>(0.5 * angle);
  Quaternion q;
  q.w() = cosine;
  q.vec() = sine * axis.cast<Extended>();
  return q;
}

}  // namespace

double sin(double x) {
  return std::isfinite(x) ? static_cast<double>(sine_cosine(x).sine) : kNaN;
}
double cos(double x) {
  return std::isfinite(x) ? static_cast<double>(sine_cosine(x).cosine) : kNaN;
}
double tan(double x) {
  if (!std::isfinite(x)) return kNaN;
  const auto [sine, cosine] = sine_cosine(x);
  return static_cast<double>(Extended(sine / cosine));
}
double atan(double x) {
  return atan2(x, 1);
}
double acos(double x) {
  using std::sqrt;
  if (!(x >= -1 && x <= 1)) return kNaN;
  return static_cast<double>(
      extended::arc_tangent<Extended>(sqrt(Extended((1 - Extended(x)) * (1 + Extended(x)))), x));
}
double atan2(double y, double x) {
  if (!std::isfinite(x) || !std::isfinite(y)) return kNaN;
  if (x == 0 && y == 0) return 0;
  return static_cast<double>(extended::arc_tangent<Extended>(y, x));
}

// Logarithms in parts: see extended::power().
double exp(double x) {
  constexpr double kLog2 = 0x1.71547652b82fep+0;
  return power_in_range(x, kLog2, [](const Extended& e) {
    return extended::power<Extended>(e, kLog2, {1, 0},
                                     {0x1.62e42fefa4p-1, -0x1.8432a1b0e2634p-43, 0x1.f97b57a079a19p-103});
  });
}
double exp2(double x) {
  return power_in_range(x, 1, [](const Extended& e) {
    return extended::power<Extended>(e, 1, {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56}, {1, 0, 0});
  });
}
double pow10(double x) {
  constexpr double kLog2 = 0x1.a934f0979a371p+1;
  return power_in_range(x, kLog2, [](const Extended& e) {
    return extended::power<Extended>(e, kLog2, {0x1.26bb1bbb55516p+1, -0x1.f48ad494ea3e9p-53},
                                     {0x1.34413509f8p-2, -0x1.80433b83b532ap-44, 0x1.6f922f04d5a62p-102});
  });
}

Eigen::Matrix3d rotation(const Eigen::Vector3d& axis, double angle) {
  const FloatMode float_mode;
  if (!std::isfinite(angle) || !axis.allFinite()) return Eigen::Matrix3d::Constant(kNaN);
  return extended::rotation<Extended>(axis.cast<Extended>(), angle).cast<double>();
}

Eigen::Matrix3d rotation_between(const Eigen::Vector3d& axis_0, double angle_0, const Eigen::Vector3d& axis_1,
                                 double angle_1, double t) {
  const FloatMode float_mode;
  using std::sqrt;
  const Quaternion from = quaternion(axis_0, angle_0), to = quaternion(axis_1, angle_1);
  Extended share = t, cosine = from.dot(to);
  const bool flipped = cosine < 0;  // -q is the same rotation as q; this one is nearer
  if (flipped) cosine = -cosine;
  Extended first = 1 - share, second = share;
  // For nearly equal rotations, linear interpolation is as accurate.
  if (cosine < 1 - Extended(std::numeric_limits<double>::epsilon()) / 2048) {
    const Extended angle =
        extended::arc_tangent<Extended>(sqrt(Extended((1 - cosine) * (1 + cosine))), cosine);
    const Extended sine = extended::sine_cosine(angle).sine;
    first = extended::sine_cosine<Extended>(first * angle).sine / sine;
    second = extended::sine_cosine<Extended>(second * angle).sine / sine;
  }
  if (flipped) second = -second;
  return Quaternion(first * from.coeffs() + second * to.coeffs()).toRotationMatrix().cast<double>();
}

}  // namespace lrb::deterministic
