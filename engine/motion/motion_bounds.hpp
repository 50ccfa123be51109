#pragma once
/// Bounds on the motion of a body in a piece of its motion, each rounded upward; and on the time for which
/// two moving simplices are separate.
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

#include <vector>

#include "engine/collide/query_context.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/distance/pair_bounds.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/first_contact.hpp>
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

// Two moving simplices: bounds on the time for which a slab separates them.
//
// Along a direction n, a corner b of B is ahead of a corner a of A by n . (b - a). At a time d later, in the
// same piece of both motions, it is ahead by at least (Taylor's theorem)
//     q(d) = c + v d - k d^2 / 2,
// where c is the offset n . (b - a) now, v is n . (velocity of b - velocity of a), and k is |n| times the
// bounds of both accelerations. c and v are rounded downward by the error bounds of positions and velocities
// (above) and of products (pair_bounds.cpp). q is concave: if it is positive at both ends of an interval of
// d, it is positive throughout. If that is true for every corner of B against every corner of A, n . x
// separates the simplices, whose points are averages of their corners with constant weights.
//
// "Separated" applies both to the exact motions and to the doubles of Motion::at() and Pose::apply() at any
// double t. The doubles deviate from the exact motions by at most MovingBody::rounding(). c allows for this
// twice: once for now, when the doubles are read, and once for later.

class PairMotion {
 public:
  PairMotion(const MovingBody& a, const MovingBody& b, SimplexPair pair);

  /// Moves the corners to their positions at the time of these states.
  void place(const PieceState& a, const PieceState& b);

  /// From now on, separated_for() takes the direction of accelerations into account. This is slower, but
  /// yields longer times for directions near a body's axis.
  void look_at_axes() { looks_at_axes_ = true; }
  /// Returns the time for which the slab normal to n (any length, either sign) is proven to separate the
  /// simplices, starting now, or 0 if it does not separate them.
  double separated_for(const Eigen::Vector3d& n) const;
  /// Returns an error bound of the product of n and a difference of two corners, covering positions both now
  /// and later.
  double places_rounding(const Eigen::Vector3d& n) const;
  PairBounds bounds() const;
  /// Returns the approximate vector from the first simplex to the second.
  Eigen::Vector3d ahead() const { return centroid(1) - centroid(0); }
  /// Returns the speed at which the closest points approach each other along the unit direction n.
  double approach_speed(const PairBounds& at, const Eigen::Vector3d& n) const;

  /// Returns true if the simplices are proven, by continuity, to have intersected between an earlier
  /// placement and this one. n: a direction that separated them then, from A to B. time: upper bound on the
  /// time between the two.
  bool has_passed(const PairMotion& before, const Eigen::Vector3d& n, double time) const;

 private:
  Eigen::Vector3d centroid(int side) const;

  struct Corner {
    Eigen::Vector3d x{0, 0, 0}, v{0, 0, 0};  ///< world units
    double acceleration = 0;
    Eigen::Vector3d in_body{0, 0, 0}, spin{0, 0, 0};
  };
  Eigen::Vector3d velocity_at(int side, const exact::Feature& on, const Eigen::Vector3d& point) const;
  Eigen::Vector3d look_along(const Eigen::Vector3d& n) const;

  const MovingBody* body_[2];
  int n_;
  Corner corner_[2][3];
  bool looks_at_axes_ = false;
  double reach_ = 0;  ///< largest coordinate of a corner, relative to A's first
};

// All pairs of simplices that may intersect in a time interval.

/// Returns true if the kernel for rotations is suitable for finding pairs. It is correct for all maps, but
/// keeps all pairs of bodies that are scaled or sheared.
bool suits_sweeps(const MovingBody& a, const MovingBody& b);

/// Finds a list of pairs that contains all pairs that intersect at any t of the interval, which must be in
/// one piece of both motions; valid both for the exact motions and for their doubles. The two trees are
/// traversed once, with B swept through the interval. At t, B is displaced from its position at the middle by
/// (t - midpoint) times its points' velocities there, with a deviation of at most (t - midpoint)^2 / 2 times
/// their accelerations. A's rotation is allowed for in every direction. Returns false if there are more than
/// `most` pairs, or if finding them takes too long (never if `most` is kNoLimit).
bool find_swept_pairs(QueryContext& ctx, const MovingBody& a, const MovingBody& b, TimeSpan span,
                      std::uint64_t most, std::vector<SimplexPair>& pairs);

}  // namespace lrb
