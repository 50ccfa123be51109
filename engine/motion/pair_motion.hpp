#pragma once
/// Two moving simplices: bounds on the time for which a slab separates them.
///
/// Along a direction n, a corner b of B is ahead of a corner a of A by n . (b - a). At a time d later, in the
/// same piece of both motions, it is ahead by at least (Taylor's theorem)
///     q(d) = c + v d - k d^2 / 2,
/// where c is the offset n . (b - a) now, v is n . (velocity of b - velocity of a), and k is |n| times the
/// bounds of both accelerations. c and v are rounded downward by the error bounds of positions and velocities
/// (motion_bounds.hpp) and of products (pair_bounds.cpp). q is concave: if it is positive at both ends of an
/// interval of d, it is positive throughout. If that is true for every corner of B against every corner of A,
/// n . x separates the simplices, whose points are averages of their corners with constant weights.
///
/// "Separated" applies both to the exact motions and to the doubles of Motion::at() and Pose::apply() at any
/// double t. The doubles deviate from the exact motions by at most MovingBody::rounding(). c allows for this
/// twice: once for now, when the doubles are read, and once for later.

#include <vector>

#include "engine/collide/query_context.hpp"
#include "engine/distance/pair_bounds.hpp"
#include "engine/motion/motion_bounds.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/first_contact.hpp>

namespace lrb {

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
  double places_rounding(const Eigen::Vector3d& n) const;

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
