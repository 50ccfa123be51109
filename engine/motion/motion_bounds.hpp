#pragma once
/// Bounds on the motion of a body in a piece of its motion, each rounded upward.
///
/// With z = first.r x + first.t for a point x of the body, T = end - begin, w = turn / T and E(t) = exp(s
/// [turn]), the position, velocity and acceleration of the point are
///     r E z + (1 - s) from + s to,    r E (w x z) + (to - from) / T,    r E (w x (w x z)),
/// because [w] commutes with E. E preserves lengths, so the rotational parts of velocity and acceleration are
/// at most |r| |w x z| and |r| |w| |w x z| long at all t.
///
/// Rounding. Let N = |r| |first.r|, in Euclidean and Frobenius norms, X bound |x|, P = |r| |first.t|, Q = the
/// larger of |from| and |to|, u = 2^-53, and S = N X + P + Q. Pose::apply() adds four terms, with a rounding
/// error of at most 4 u S. Rounding the entries of the pose to double adds u S. In extended.hpp, u' = 2^-64,
/// the relative errors of s and of the direction of s turn are at most 4 u'; the relative error of the angle,
/// which is at most |turn|, is 6 u' (1 u' for large angles); and sines, cosines and the products that form
/// the rotation add 24 u'. Together that is (60 + 12 |turn|) u' S < (2^-5 + 2^-7 |turn|) u S. The sum is
/// below (5.1 + 2^-7 |turn|) u S <= 8 u S (1 + 2^-10 |turn|): kMotionRounding is 8 u.
///
/// A velocity is computed in double with a dozen roundings of terms that are each at most V = (|turn| (N X +
/// P) + |from| + |to|) / T; 4 kMotionRounding (1 + 2^-10 |turn|) V, that is 32 u, covers them and a product
/// with a direction.

#include "engine/core/tolerances.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/motion.hpp>

namespace lrb {

struct PieceState {
  Pose pose;               ///< of the body, as Motion::at()
  Eigen::Matrix3d turned;  ///< r exp(s [turn])
};

/// Returns the state of a piece at a t between its start and its end.
PieceState state_of(const Motion::Piece& piece, double t);

/// Covers a dozen roundings of non-negative numbers.
inline constexpr double kWorldUp = 1 + kWorldRounding;

/// One body in one piece of its motion. World units; times are the motion's.
class MovingBody {
 public:
  /// Keeps references; the body must not be empty.
  MovingBody(const LrbRep& rep, const Motion::Piece& piece);

  const LrbRep& rep() const { return *rep_; }
  const Motion::Piece& piece() const { return *piece_; }
  PieceState at(double t) const { return state_of(*piece_, t); }

  /// Returns a bound on the deviation of a vertex in doubles, moved by Pose::apply(), from its exact position
  /// at any t.
  double rounding() const { return rounding_; }
  /// Returns a bound on the error of n . v(t) for a unit direction n and a velocity v in doubles.
  double velocity_rounding() const { return velocity_rounding_; }
  /// Returns the velocity common to all points, from the translation along the path.
  const Eigen::Vector3d& travel() const { return travel_; }
  /// Returns the angular speed.
  double turn_rate() const { return turn_rate_; }
  /// Returns an upper bound on every point's rotational speed.
  double spin() const { return spin_; }
  /// Returns an upper bound on every point's acceleration.
  double acceleration() const { return spin_ * turn_rate_; }
  /// Returns an upper bound on the displacement of any point by rotation within a length of time.
  double turned_by(double time) const;

  /// A point's rotational velocity, before multiplication by r, and its acceleration.
  struct Spin {
    Eigen::Vector3d velocity;  ///< w x z
    double acceleration;       ///< upper bound, including r
  };
  Spin spin_of(const Eigen::Vector3d& x) const;
  /// Returns an upper bound on the component of the acceleration along a direction n, relative to |n| times
  /// Spin::acceleration, at all times. n . r E (w x (w x z)) is the product of E^T r^T n and a vector
  /// perpendicular to w, so only the part of r^T n perpendicular to w contributes: E rotates about w.
  double share_along(const Eigen::Vector3d& n) const;

 private:
  double farthest_from_axis() const;

  const LrbRep* rep_;
  const Motion::Piece* piece_;
  Eigen::Vector3d travel_, rate_;  ///< rate_: w
  double stretch_ = 1;             ///< |r|
  double turn_rate_ = 0, spin_ = 0, rounding_ = 0, velocity_rounding_ = 0;
};

}  // namespace lrb
