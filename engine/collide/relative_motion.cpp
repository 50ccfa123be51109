/// Predicts the motion of B relative to A from its last three poses, by repeating the last step.
///
/// 1. record() keeps a pose on A's axes and bounds its rounding.
/// 2. ahead() extrapolates a straight sweep, as long as the deviation of the last step from the one before
///    allows.
/// 3. along() projects a pose onto a sweep by least squares and bounds the distance of all points from it.

#include "engine/collide/relative_motion.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/LU>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kRemembered = 3;
/// Half a sweep has at most n = kDeviation s / d steps, where s is the length of the last step and d its
/// deviation from the step predicted by the two poses before. At the end of the sweep, after 2 n steps, the
/// deviation 2 n^2 d is then at most n s / 2.
constexpr double kDeviation = 0.25;
/// Lengths relative to a step: extension of a sweep at either end, and its minimum width. kSpareWidth: width
/// relative to the current deviation of B, because the path is curved as much at the other end.
constexpr double kBeyondEnd = 0.125, kMinWidth = 1.0 / 16, kSpareWidth = 1.25;

/// Returns the motion x -> m x + t, on A's axes, that takes B from one pose to the other.
RelativePose motion_between(const RelativePose& from, const RelativePose& to) {
  const Matrix3d m = to.m * from.m.transpose();
  return {m, to.t - m * from.t};
}

RelativePose after(const RelativePose& motion, const RelativePose& pose) {
  return {motion.m * pose.m, motion.m * pose.t + motion.t};
}

}  // namespace

RelativePose::RelativePose(const Matrix3d& m_, const Vector3d& t_)
    : m(m_), t(t_), defect(rotation_defect(m_)) {}

RelativeMotion::RelativeMotion(const LrbRep& a, const LrbRep& b) : a_(&a), b_(&b) {
  // The root's bounding sphere contains all of B.
  const TreeNode& root = b.tree().nodes()[0];
  centre_ = Vector3d(root.origin[0], root.origin[1], root.origin[2]) * b.tree().unit();
  radius_ = static_cast<double>(root.radius) * b.tree().unit();
}

bool RelativeMotion::record(const Pose& pose_a, const Pose& pose_b) {
  const double defect_a = rotation_defect(pose_a.r);
  earlier_ = last_;
  last_ = now_;
  // B seen from A: x -> R_A^T (R_B x + t_B - t_A).
  now_ = {pose_a.r.transpose() * pose_b.r, pose_a.r.transpose() * (pose_b.t - pose_a.t)};
  // R_A^T is the inverse only up to A's defect, which shifts points on A's axes relative to their size.
  rounding_ = wrapper_margin(pose_a, a_->tree(), pose_b, b_->tree()) + 2 * defect_a * a_->tree().extent();
  // A relative reflection is not a rigid motion.
  if (defect_a <= kRigid && now_.defect <= kRigid && now_.m.determinant() > 0) {
    seen_ = std::min(seen_ + 1, kRemembered);
    return true;
  }
  forget();
  return false;
}

/// Returns a bound on |dm x + dt| for points x of B, where |dm| <= turn.
double RelativeMotion::farthest(const Matrix3d& dm, const Vector3d& dt, double turn) const {
  // The displacement of B's centre, and the effect of the rotation over B's radius.
  return (stable_norm3(dm * centre_ + dt) + turn * radius_) * (1 + kWorldRounding) + rounding_;
}

double RelativeMotion::motion(const RelativePose& from, const RelativePose& to) const {
  const Matrix3d dm = to.m - from.m;
  return farthest(dm, to.t - from.t, turn_bound(dm, from.defect + to.defect));
}

double RelativeMotion::step() const {
  // Without a previous pose nothing bounds the step.
  return seen_ < 2 ? std::numeric_limits<double>::infinity() : motion(last_, now_);
}

/// Returns the sweep over the next 2 `steps` steps, extended a little at both ends.
Sweep RelativeMotion::sweep_of(int steps) const {
  const RelativePose motion = motion_between(last_, now_);
  Sweep s;
  // Repeat the last step: `steps` times to the mid_pose, and as often again to the end.
  RelativePose end = now_;
  for (int i = 0; i < steps; ++i) end = after(motion, end);
  s.mid_pose = end;
  for (int i = 0; i < steps; ++i) end = after(motion, end);
  // Half the chord from now to the end, extended by kBeyondEnd steps at either end.
  const double longer = 1 + kBeyondEnd / steps;
  s.dm = (end.m - now_.m) * (longer / 2);
  s.dt = (end.t - now_.t) * (longer / 2);
  // The Frobenius norm bounds the spectral norm. A scaled chord is not a difference of two rotations, so that
  // turn_bound() does not apply.
  s.turn = s.dm.norm() * (1 + kWorldRounding);
  s.length = farthest(s.dm, s.dt, s.turn);
  return s;
}

bool RelativeMotion::is_seen() const {
  return seen_ == kRemembered;
}

bool RelativeMotion::is_kept() const {
  return is_seen() && steady_steps() >= 1;
}

double RelativeMotion::deviation() const {
  // Distance of the current pose from the one extrapolated from the two poses before.
  return motion(after(motion_between(earlier_, last_), last_), now_);
}

/// Returns half the number of steps for which B's motion is predictable. A deviation d in one step grows to
/// n^2 / 2 d in n steps.
double RelativeMotion::steady_steps() const {
  return kDeviation * motion(last_, now_) / deviation();
}

Sweep RelativeMotion::ahead(double steps) const {
  const int half = std::max(1, static_cast<int>(std::min(steps / 2, steady_steps())));
  Sweep ahead = sweep_of(half);
  // Extrapolation errors grow quadratically: n^2 / 2 deviations in n = 2 half steps.
  ahead.width = kMinWidth * motion(last_, now_) + 2 * half * half * deviation();
  // B deviates from the chord already, and will deviate about as much at the other end.
  ahead.width = std::max(ahead.width, kSpareWidth * along(ahead).offset);
  return ahead;
}

Sweep RelativeMotion::about(double width) const {
  Sweep current;
  current.mid_pose = now_;
  current.width = width;
  return current;
}

SweepPoint RelativeMotion::along(const Sweep& s) const {
  // A fixed pose has no direction: only the distance from it counts.
  if (s.length == 0) return {0, motion(s.mid_pose, now_)};
  const Matrix3d m = now_.m - s.mid_pose.m;
  const Vector3d t = now_.t - s.mid_pose.t;
  // Least squares over B's points, approximated by a ball.
  const Vector3d direction = (s.dm * centre_ + s.dt) / s.length, gone = (m * centre_ + t) / s.length;
  const double spread = radius_ / s.length * (radius_ / s.length) / 2;
  const double nearest = (gone.dot(direction) + spread * m.cwiseProduct(s.dm).sum()) /
                         (direction.squaredNorm() + spread * s.dm.squaredNorm());
  const double at = nearest > -1 ? std::min(nearest, 1.0) : -1;  // also -1 if overflow made it NaN
  // Whatever the fit, the residual is a valid bound: a poor fit only costs a new cache.
  const Matrix3d off_m = m - at * s.dm;
  return {at, farthest(off_m, t - at * s.dt, off_m.norm())};
}

}  // namespace lrb
