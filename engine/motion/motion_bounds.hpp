#pragma once
/// Bounds on how a body moves in a piece of its motion, each rounded upward.
///
/// With z = first.r x + first.t for a point x of the body, T = end - begin, w = turn / T and E(t) = exp(s
/// [turn]), its place, velocity and acceleration are
///     r E z + (1 - s) from + s to,    r E (w x z) + (to - from) / T,    r E (w x (w x z)),
/// because [w] commutes with E. E keeps lengths, so that the parts of velocity and acceleration that come
/// from turning are no longer than |r| |w x z| and |r| |w| |w x z|, whatever t is.
///
/// Rounding. Let N = |r| |first.r|, in Euclidean and Frobenius norms, X bound |x|, P = |r| |first.t|, Q = the
/// larger of |from| and |to|, u = 2^-53, and S = N X + P + Q. Pose::apply() adds four terms, which rounds by
/// at most 4 u S. Entries of the pose are rounded to double, which makes u S. What is computed in long
/// double, u' = 2^-64, has relative errors of at most 4 u' in s and in s turn's direction, and the angle, at
/// most |turn|, is off by 5 u' of itself; sines, cosines and the products that make up the rotation add 24
/// u'. Together that is (60 + 10 |turn|) u' S < (2^-5 + 2^-7 |turn|) u S. The sum is below (5.1 + 2^-7
/// |turn|) u S <= 8 u S (1 + 2^-10 |turn|): kMotionRounding is 8 u. A velocity is computed in doubles with a
/// dozen roundings of terms of which none exceeds V = (|turn| (N X + P) + |from| + |to|) / T; 4
/// kMotionRounding (1 + 2^-10 |turn|) V, 32 u, covers them and a product with a direction.

#include "engine/core/tolerances.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/motion.hpp>

namespace lrb {

// A piece of a motion at one t, in doubles.

struct PieceState {
  Pose pose;               ///< of the body: Motion::at()
  Eigen::Matrix3d turned;  ///< r exp(s [turn])
};

/// Returns a piece at a t from its begin to its end.
PieceState state_of(const Motion::Piece& piece, double t);

/// Covers a dozen roundings of numbers that are not negative.
inline constexpr double kWorldUp = 1 + kWorldRounding;

/// One body in one piece of its motion. Unit: the world's; times are those of the motion.
class MovingBody {
 public:
  /// Keeps references; the body must not be empty.
  MovingBody(const LrbRep& rep, const Motion::Piece& piece);

  const LrbRep& rep() const { return *rep_; }
  const Motion::Piece& piece() const { return *piece_; }
  PieceState at(double t) const { return state_of(*piece_, t); }

  /// Returns how far a vertex in doubles, moved by Pose::apply(), may be off its exact place at any t.
  double rounding() const { return rounding_; }
  /// Returns how far n . v(t) may be off for a direction n of length 1 and a velocity v in doubles.
  double velocity_rounding() const { return velocity_rounding_; }
  /// Returns the velocity that all points have in common, by the motion along its path.
  const Eigen::Vector3d& travel() const { return travel_; }
  /// Returns the angle by which the body turns per time.
  double turn_rate() const { return turn_rate_; }
  /// Returns a bound on every point's speed by turning.
  double spin() const { return spin_; }
  /// Returns a bound on every point's acceleration.
  double acceleration() const { return spin_ * turn_rate_; }
  /// Returns a bound on how far turning moves any point in a time.
  double turned_by(double time) const;

  /// A point's speed and acceleration by turning, before r.
  struct Spin {
    Eigen::Vector3d velocity;  ///< w x z
    double acceleration;       ///< a bound on the acceleration, with r
  };
  Spin spin_of(const Eigen::Vector3d& x) const;
  /// Returns a bound on how much of Spin::acceleration there is along a direction n, as a share of |n| times
  /// it, at all times. n . r E (w x (w x z)) is a product of E^T r^T n and a vector across w, of which only
  /// the part of r^T n across w counts: E turns about w.
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
