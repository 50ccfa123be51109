#include "engine/query/motion/motion_bounds.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"
#include "engine/tree/pose_bounds.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

/// Calls see(origin, radius), in the body's unit, for balls that together enclose the body: those of the
/// nodes two levels below the root. Tighter than the root's own ball, at constant cost.
template <class See>
void for_each_ball(const ObbTree& tree, See&& see) {
  const auto nodes = tree.nodes().data();
  const auto show = [&](const TreeNode& n) {
    see(Vector3d(n.origin[0], n.origin[1], n.origin[2]) * tree.unit(),
        static_cast<double>(n.radius) * tree.unit());
  };
  const TreeNode& root = nodes[0];
  if (root.is_leaf) return show(root);
  for (std::uint32_t i = 0; i < root.count; ++i) {
    const TreeNode& child = nodes[root.first + i];
    if (child.is_leaf) show(child);
    for (std::uint32_t j = 0; !child.is_leaf && j < child.count; ++j) show(nodes[child.first + j]);
  }
}

}  // namespace

MovingBody::MovingBody(const LrbRep& rep, const Motion::Piece& piece) : rep_(&rep), piece_(&piece) {
  const double time = piece.end - piece.begin, angle = piece.turn.stableNorm() * kWorldUp;
  // Velocities per unit of t. Rotation leaves the travel alone.
  travel_ = (piece.to - piece.from) / time;
  rate_ = piece.turn / time;
  stretch_ = stretch({piece.r, {0, 0, 0}});
  // Rates that serve as bounds are rounded up.
  turn_rate_ = angle / time * kWorldUp;
  spin_ = angle > 0 ? stretch_ * farthest_from_axis() * kWorldUp : 0;
  // In the terms of motion_bounds.hpp: size = X, turned = N X + P, path = Q.
  const double size = std::sqrt(3.0) * rep.tree().extent();
  const double frobenius = std::sqrt(3.0) * stretch(piece.first);
  const double turned = stretch_ * (frobenius * size + piece.first.t.stableNorm());
  const double path = std::max(piece.from.stableNorm(), piece.to.stableNorm());
  // 8 u (1 + 2^-10 |turn|), the bound derived there, for places; four times that for velocities.
  const double share = kMotionRounding * (1 + 0x1p-10 * angle);
  rounding_ = share * (turned + path) * kWorldUp + kWorldUnderflow;
  velocity_rounding_ = 4 * share * (angle * turned + 2 * path) / time * kWorldUp + kWorldUnderflow;
}

/// Returns a bound on |w x z|.
double MovingBody::farthest_from_axis() const {
  const double size = stretch(piece_->first);
  double most = 0;
  for_each_ball(rep_->tree(), [&](const Vector3d& origin, double radius) {
    const Vector3d z = piece_->first.r * origin + piece_->first.t;
    // Rounding of z and of the cross product.
    const double rounding =
        4 * kMotionRounding * (2 * size * rep_->tree().extent() + piece_->first.t.stableNorm());
    // The speed of the ball's centre, and at most |w| times the radius more at its rim.
    most = std::max(most, rate_.cross(z).stableNorm() + turn_rate_ * (size * radius + rounding));
  });
  return most * kWorldUp;
}

double MovingBody::turned_by(double time) const {
  // A chord is no longer than its arc, nor than twice the distance from the axis.
  return turn_rate_ > 0 ? std::min(spin_ * time, 2 * spin_ / turn_rate_) * kWorldUp : 0;
}

MovingBody::Spin MovingBody::spin_of(const Vector3d& x) const {
  if (!(turn_rate_ > 0)) return {Vector3d::Zero(), 0};
  const Vector3d z = piece_->first.r * x + piece_->first.t;
  Spin spin{rate_.cross(z), 0};
  // Rounding of z and of the cross product, which the bound on the acceleration has to include.
  const double rounding = 4 * kMotionRounding * turn_rate_ * (z.norm() + piece_->first.t.norm());
  spin.acceleration = stretch_ * turn_rate_ * (spin.velocity.norm() + rounding) * kWorldUp;
  return spin;
}

double MovingBody::share_along(const Vector3d& n) const {
  if (!(turn_rate_ > 0)) return 1;
  const Vector3d across = (piece_->r.transpose() * n).cross(piece_->turn.stableNormalized());
  // Products, and the axis, are off by less than 16 u |r| |n|.
  const double share = across.norm() / (stretch_ * n.norm()) * kWorldUp + kWorldRounding;
  return share < 1 ? share : 1;  // not a number: 1
}

}  // namespace lrb
