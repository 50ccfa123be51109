#include "engine/query/course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "engine/query/pose_bounds.hpp"
#include "engine/tolerances.hpp"

namespace lrb {
namespace {

constexpr int kRemembered = 3;
/// B keeps its course while it is no further from where it was expected than this share of the step.
constexpr double kOffCourse = 0.25;
/// At least 1 + sqrt(3 / 2): for going from matrices to the rotations that they are near.
constexpr double kToRotations = 2.3;

/// The motion that takes B from one pose to the other, on A's axes: x -> m x + t.
RelativePose motion_between(const RelativePose& from, const RelativePose& to) {
  const Eigen::Matrix3d m = to.m * from.m.transpose();
  return {m, to.t - m * from.t};
}

RelativePose after(const RelativePose& motion, const RelativePose& pose) {
  return {motion.m * pose.m, motion.m * pose.t + motion.t};
}

}  // namespace

RelativePose::RelativePose(const Eigen::Matrix3d& m_, const Eigen::Vector3d& t_)
    : m(m_), t(t_), defect(rotation_defect(m_)) {}

Course::Course(const LrbRep& a, const LrbRep& b) : a_(&a), b_(&b) {
  const TreeNode& root = b.tree().nodes()[0];
  middle_ = Eigen::Vector3d(root.origin[0], root.origin[1], root.origin[2]) * b.tree().unit();
  radius_ = static_cast<double>(root.radius) * b.tree().unit();
}

bool Course::see(const Pose& pose_a, const Pose& pose_b) {
  const double defect_a = rotation_defect(pose_a.r);
  earlier_ = last_;
  last_ = now_;
  now_ = {pose_a.r.transpose() * pose_b.r, pose_a.r.transpose() * (pose_b.t - pose_a.t)};
  rounding_ = wrapper_margin(pose_a, a_->tree(), pose_b, b_->tree()) + 2 * defect_a * a_->tree().extent();
  if (defect_a <= kRigid && now_.defect <= kRigid && now_.m.determinant() > 0) {
    seen_ = std::min(seen_ + 1, kRemembered);
    return true;
  }
  forget();
  return false;
}

double Course::motion(const RelativePose& from, const RelativePose& to) const {
  const Eigen::Matrix3d dm = to.m - from.m;
  const double turn = std::sqrt(dm.squaredNorm() / 2) + kToRotations * (from.defect + to.defect);
  const double shift = (dm * middle_ + (to.t - from.t)).stableNorm();
  return (shift + turn * radius_) * (1 + kWorldRounding) + rounding_;
}

double Course::step() const {
  return seen_ < 2 ? std::numeric_limits<double>::infinity() : motion(last_, now_);
}

RelativePose Course::ahead(int steps) const {
  if (seen_ < kRemembered ||
      motion(after(motion_between(earlier_, last_), last_), now_) > kOffCourse * motion(last_, now_))
    return now_;
  const RelativePose way = motion_between(last_, now_);
  RelativePose pose = now_;
  for (int i = 0; i < steps; ++i) pose = after(way, pose);
  return pose;
}

}  // namespace lrb
