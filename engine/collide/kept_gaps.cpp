#include "engine/collide/kept_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

/// The corners of a face in the world.
std::vector<Vector3d> corners_of(QueryBody& body, FaceId f) {
  std::vector<Vector3d> out;
  for (const VertexId v : body.rep().face(f)) out.emplace_back(body.world(v));
  return out;
}

/// Returns a direction across a face: of the normal of its first three corners, in 2D of the segment.
Vector3d across(const std::vector<Vector3d>& p) {
  const Vector3d along = p[1] - p[0];
  return p.size() == 2 ? Vector3d(-along.y(), along.x(), 0) : Vector3d(along.cross(p[2] - p[0]));
}

/// Returns a lower bound of the distance of two polygons, up to rounding: their gap along one of a few axes.
double gap_between(const std::vector<Vector3d>& p, const std::vector<Vector3d>& q) {
  double widest = 0;
  for (const Vector3d& axis : {across(p), across(q), Vector3d(q[0] - p[0]), Vector3d(1, 0, 0),
                               Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
    const double length = stable_norm3(axis);
    if (!(length > 0) || !std::isfinite(length)) continue;
    const Vector3d unit = axis / length;  // before the products, which would overflow or underflow
    double low[2], high[2];
    for (int k = 0; k < 2; ++k) {
      low[k] = std::numeric_limits<double>::infinity();
      high[k] = -low[k];
      for (const Vector3d& x : k == 0 ? p : q) {
        const double at = dot3(unit, x);
        low[k] = std::min(low[k], at);
        high[k] = std::max(high[k], at);
      }
    }
    widest = std::max({widest, low[1] - high[0], low[0] - high[1]});
  }
  return widest;
}

}  // namespace

KeptGaps::KeptGaps(const LrbRep& a, const LrbRep& b) {
  Eigen::AlignedBox3d box;
  for (int k = 0; k < 2; ++k) {
    size_[k] = 0;
    for (const Vector3d& v : (k == 0 ? a : b).vertices()) {
      size_[k] = std::max(size_[k], stable_norm3(v));
      if (k == 1) box.extend(v);
    }
  }
  for (int i = 0; i < 8; ++i) corners_of_b_[i] = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
}

void KeptGaps::begin(const Pose& pose_a, const Pose& pose_b) {
  // Pairs that are no longer asked for go with the others, in the rare step that finds too many of them.
  if (until_.size() > 4 * requested_ + 1000) forget();
  requested_ = saved_ = 0;
  for (auto& regions : reached_) regions.clear();
  const RelativePose now(pose_a.r.transpose() * pose_b.r, pose_a.r.transpose() * (pose_b.t - pose_a.t));
  const bool was_rigid = is_rigid_;
  is_rigid_ = RelativePose(pose_a.r, pose_a.t).defect <= kRigid && now.defect <= kRigid;
  // The motion is affine in the points of B, so that a corner of its box moves farthest.
  double step = 0;
  for (const Vector3d& x : corners_of_b_)
    step = std::max(step, stable_norm3((now.m - last_.m) * x + (now.t - last_.t)));
  // Rounded up, so that the sum of many small steps stays a bound. A long way starts again: its rounding
  // errors would exceed rounding_.
  constexpr double kUp = 1 + 0x1p-48, kFar = 1000;
  moved_ = std::nextafter(moved_ + step * kUp, std::numeric_limits<double>::infinity());
  rounding_ =
      8 * kRigid * (size_[0] + size_[1] + stable_norm3(pose_a.t) + stable_norm3(pose_b.t)) + kWorldUnderflow;
  last_ = now;
  const bool is_far = !(moved_ <= kFar * (size_[0] + size_[1]));
  if (!is_rigid_ || !was_rigid || is_far || !std::isfinite(moved_ + rounding_)) {
    forget();
    moved_ = 0;
  }
}

bool KeptGaps::are_apart(FaceId a, FaceId b) {
  ++requested_;
  const auto known = until_.find(key(a, b));
  const bool apart = known != until_.end() && known->second > moved_ + rounding_;
  saved_ += apart;
  return apart;
}

void KeptGaps::keep(QueryContext& context, FaceId a, FaceId b) {
  if (!is_rigid_) return;
  const double gap = gap_between(corners_of(context[Side::a], a), corners_of(context[Side::b], b));
  if (gap > 2 * rounding_) until_[key(a, b)] = moved_ + gap - rounding_;
}

}  // namespace lrb
