/// Motions by rotation about a fixed axis at constant speed plus constant translation, piece by piece.
///
/// Poses are computed with significands of 64 bits, with functions that are the same on every processor
/// (core/extended.hpp), and rounded to double once. motion_bounds.hpp bounds the error.

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include "engine/core/extended.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/motion/motion_bounds.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/motion.hpp>

namespace lrb {
namespace {

using Real = Extended;
using Matrix = Eigen::Matrix<Real, 3, 3>;
using Vector = Eigen::Matrix<Real, 3, 1>;

Matrix rotation_by(const Vector& turn) {
  const Real angle = turn.norm();
  if (!(angle > 0)) return Matrix::Identity();
  return extended::rotation<Real>(turn / angle, angle);
}

/// Returns the rotation vector, of length at most pi, of a matrix that is nearly a rotation.
Eigen::Vector3d logarithm(const Matrix& m) {
  Eigen::Quaternion<Real> q(m);
  // The matrix is only nearly a rotation; normalise its quaternion.
  q.normalize();
  Vector axis = q.vec();
  const Real sine = axis.norm();
  if (!(sine > 0)) return {0, 0, 0};
  // q and -q are the same rotation: w >= 0 selects the shorter arc. At half a turn both arcs are equally
  // long, and the sign of the axis is chosen by convention.
  int first = 0;
  while (axis[first] == 0) ++first;
  if (q.w() < 0 || (q.w() == 0 && axis[first] < 0)) axis = -axis;
  // The arc tangent is accurate at all angles; acos(w) is not near 0.
  const Real w = q.w() < 0 ? Real(-q.w()) : q.w();
  return (axis * Real(2 * extended::arc_tangent<Real>(sine, w) / sine)).cast<double>();
}

void check_rotation(const Eigen::Matrix3d& r, const char* which) {
  const double defect = rotation_defect(r);
  if (!(defect <= kMotionDefect))
    throw InputError(std::string("the motion's ") + which +
                     " pose: expected a rotation matrix (orthonormal columns, tolerance 0.001)");
}

/// Returns the piece between two poses.
Motion::Piece piece_between(const Pose& start, const Pose& end) {
  Motion::Piece piece;
  piece.r = start.r;
  piece.from = start.t;
  piece.to = end.t;
  // Equal matrices: a translation, for which the matrix need not be a rotation.
  if (start.r == end.r) return piece;
  check_rotation(start.r, "first");
  check_rotation(end.r, "second");
  const Matrix turn = start.r.cast<Real>().transpose() * end.r.cast<Real>();
  // A negative determinant: no rotation leads from one matrix to the other.
  if (!(turn.determinant() > 0))
    throw InputError("the motion's poses: expected two rotations, found a reflection");
  piece.turn = logarithm(turn);
  return piece;
}

bool is_finite(const Motion::Piece& p) {
  return std::isfinite(p.begin) && std::isfinite(p.end) && p.first.r.allFinite() && p.first.t.allFinite() &&
         p.turn.allFinite() && p.r.allFinite() && p.from.allFinite() && p.to.allFinite();
}

}  // namespace

Motion::Motion(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  const FloatMode float_mode;
  double t = 0;
  for (const Piece& piece : pieces_) {
    if (!is_finite(piece))
      throw InputError("the motion: expected finite numbers, found a NaN or an infinity");
    // Exact comparison: pieces must neither overlap nor leave gaps.
    if (piece.begin != t || !(piece.end > piece.begin))
      throw InputError(
          "the motion's times must ascend from 0 to 1, and each piece must begin where the previous one ends");
    t = piece.end;
  }
  if (t != 1) throw InputError("the motion's times must ascend from 0 to 1");
}

Motion Motion::still(const Pose& pose) {
  return linear(pose, pose.t);
}

Motion Motion::linear(const Pose& start, const Eigen::Vector3d& end) {
  Piece piece;
  piece.r = start.r;
  piece.from = start.t;
  piece.to = end;
  return Motion(std::vector<Piece>{piece});
}

Motion Motion::screw(const Pose& start, const Pose& end) {
  const FloatMode float_mode;
  return Motion(std::vector<Piece>{piece_between(start, end)});
}

Motion Motion::turning(const Pose& start, const Eigen::Vector3d& turn, const Eigen::Vector3d& centre,
                       const Eigen::Vector3d& direction) {
  const FloatMode float_mode;
  Piece piece;
  // Move the centre to the origin, rotate there, and move the centre along the path.
  piece.first = {start.r, start.t - centre};
  piece.turn = turn;
  piece.from = centre;
  piece.to = centre + direction;
  return Motion(std::vector<Piece>{piece});
}

Motion Motion::key_frames(std::span<const KeyFrame> frames) {
  const FloatMode float_mode;
  if (frames.empty()) throw InputError("the motion: expected at least one key frame, found none");
  // A single frame: a body at rest.
  if (frames.size() == 1 && frames[0].t == 0) return still(frames[0].pose);
  std::vector<Piece> pieces;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    pieces.push_back(piece_between(frames[i - 1].pose, frames[i].pose));
    pieces.back().begin = frames[i - 1].t;
    pieces.back().end = frames[i].t;
  }
  return Motion(std::move(pieces));
}

PieceState state_of(const Motion::Piece& piece, double t) {
  // s is 0 at the start of the piece and 1 at its end.
  const Real s = (static_cast<Real>(t) - static_cast<Real>(piece.begin)) /
                 (static_cast<Real>(piece.end) - static_cast<Real>(piece.begin));
  const Vector from = piece.from.cast<Real>(), to = piece.to.cast<Real>();
  const Vector at = from + s * (to - from);
  PieceState state;
  if (piece.turn.isZero(0)) {
    // Without rotation: skip products with the identity, so that the doubles of the pose remain unchanged.
    state.turned = piece.r;
    state.pose.r = piece.first.r.isIdentity(0)
                       ? piece.r
                       : (piece.r.cast<Real>() * piece.first.r.cast<Real>()).cast<double>();
    state.pose.t = (at + piece.r.cast<Real>() * piece.first.t.cast<Real>()).cast<double>();
    return state;
  }
  // r exp(s [turn]), then the map of motion.hpp; each entry is rounded to double once.
  const Matrix turned = piece.r.cast<Real>() * rotation_by(s * piece.turn.cast<Real>());
  state.turned = turned.cast<double>();
  state.pose.r = (turned * piece.first.r.cast<Real>()).cast<double>();
  state.pose.t = (at + turned * piece.first.t.cast<Real>()).cast<double>();
  return state;
}

Pose Motion::at(double t) const {
  const FloatMode float_mode;
  std::size_t i = pieces_.size() - 1;
  // From the last piece backward: at a shared t the later piece counts.
  while (i > 0 && t < pieces_[i].begin) --i;
  return state_of(pieces_[i], t).pose;
}

namespace {

using Eigen::Vector3d;

/// Calls visit(origin, radius), in mesh units, for balls that together enclose the body: those of the nodes
/// two levels below the root. Tighter than the root's ball, at constant cost.
template <class Visit>
void for_each_ball(const ObbTree& tree, Visit&& visit) {
  const auto nodes = tree.nodes().data();
  const auto show = [&](const TreeNode& n) {
    visit(Vector3d(n.origin[0], n.origin[1], n.origin[2]) * tree.unit(),
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
  const double time = piece.end - piece.begin, angle = stable_norm3(piece.turn) * kWorldUp;
  // Velocities per unit of t. The rotation does not affect the travel.
  travel_ = (piece.to - piece.from) / time;
  rate_ = piece.turn / time;
  stretch_ = stretch({piece.r, {0, 0, 0}});
  // Rates used as bounds are rounded up.
  turn_rate_ = angle / time * kWorldUp;
  spin_ = angle > 0 ? stretch_ * farthest_from_axis() * kWorldUp : 0;
  // In the terms of motion_bounds.hpp: size = X, turned = N X + P, path = Q.
  const double size = std::sqrt(3.0) * rep.tree().extent();
  const double frobenius = std::sqrt(3.0) * stretch(piece.first);
  const double turned = stretch_ * (frobenius * size + stable_norm3(piece.first.t));
  const double path = std::max(stable_norm3(piece.from), stable_norm3(piece.to));
  // 8 u (1 + 2^-10 |turn|), the bound derived there, for positions; four times that for velocities.
  const double share = kMotionRounding * (1 + 0x1p-10 * angle);
  rounding_ = share * (turned + path) * kWorldUp + kWorldUnderflow;
  velocity_rounding_ = 4 * share * (angle * turned + 2 * path) / time * kWorldUp + kWorldUnderflow;
}

/// Returns an upper bound on |w x z|.
double MovingBody::farthest_from_axis() const {
  const double size = stretch(piece_->first);
  double most = 0;
  for_each_ball(rep_->tree(), [&](const Vector3d& origin, double radius) {
    const Vector3d z = piece_->first.r * origin + piece_->first.t;
    // Rounding of z and of the cross product.
    const double rounding =
        4 * kMotionRounding * (2 * size * rep_->tree().extent() + stable_norm3(piece_->first.t));
    // The speed of the ball's centre, plus at most |w| times the radius.
    most = std::max(most, stable_norm3(rate_.cross(z)) + turn_rate_ * (size * radius + rounding));
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
  // Rounding of z and of the cross product, which the bound on the acceleration must include.
  const double rounding = 4 * kMotionRounding * turn_rate_ * (z.norm() + piece_->first.t.norm());
  spin.acceleration = stretch_ * turn_rate_ * (spin.velocity.norm() + rounding) * kWorldUp;
  return spin;
}

double MovingBody::share_along(const Vector3d& n) const {
  if (!(turn_rate_ > 0)) return 1;
  const Vector3d across = (piece_->r.transpose() * n).cross(piece_->turn.stableNormalized());
  // The error of the products and of the axis is less than 16 u |r| |n|.
  const double share = across.norm() / (stretch_ * n.norm()) * kWorldUp + kWorldRounding;
  return share < 1 ? share : 1;  // NaN: 1
}

}  // namespace lrb
