#pragma once
/// Two simplices that move: for how long a slab is proved to part them.
///
/// Along a direction n, a corner b of B is ahead of a corner a of A by n . (b - a). At a time d later, in the
/// same piece of both motions, by Taylor's theorem it is so by at least
///     q(d) = c + v d - k d^2 / 2,
/// c: what it is ahead now, v: n . (velocity of b - velocity of a), k: |n| times the bounds of both
/// accelerations. c and v are rounded downward by all that may be off: places and velocities
/// (motion_bounds.hpp), products (pair_bounds.cpp). q is concave: where it is more than 0 at both ends of a
/// span of d, it is so all the while. If that holds for every corner of B against every corner of A, n . x
/// parts the simplices, which are no more than averages of their corners with weights that do not change.
///
/// "Apart" is meant both for the exact motions and for the doubles of Motion::at() and Pose::apply() at any
/// double t: the latter are off the former by MovingBody::rounding() at most, for which c makes room twice,
/// once for now, when the doubles are looked at, and once for later.

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

  /// Moves the corners to where they are at the time of these states.
  void place(const PieceState& a, const PieceState& b);

  /// From now on, parted_for() takes in how accelerations lie to the direction. It takes longer, and its
  /// times are longer where the direction is near a body's axis.
  void look_at_axes() { looks_at_axes_ = true; }
  /// Returns for how long from now on the slab across n (any length, either sign) is proved to part the
  /// simplices; 0: it does not, or not for long.
  double parted_for(const Eigen::Vector3d& n) const;
  PairBounds bounds() const;
  /// Returns about where the second simplex is, seen from the first.
  Eigen::Vector3d ahead() const { return middle(1) - middle(0); }
  /// Returns how fast the point of the first simplex comes nearer to that of the second along n, of length 1.
  double approach_speed(const PairBounds& at, const Eigen::Vector3d& n) const;

  /// Returns true if the simplices are proved to have met between an earlier placement and this one, by an
  /// argument of continuity. n: parted them then, seen from A. time: how much earlier it was, or more.
  bool has_passed(const PairMotion& before, const Eigen::Vector3d& n, double time) const;

 private:
  Eigen::Vector3d middle(int side) const;

  struct Corner {
    Eigen::Vector3d x{0, 0, 0}, v{0, 0, 0};  ///< the world
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
  double reach_ = 0;  ///< largest coordinate of a corner, seen from A's first
};

// All pairs of simplices that may meet in a span of time.

/// Tells whether the kernel for rotations can look for pairs: it is right for any maps, but keeps all pairs
/// of bodies that are scaled or sheared.
bool suits_sweeps(const MovingBody& a, const MovingBody& b);

/// Finds a list of pairs in which all are that meet at any t of the span, which lies in one piece of both
/// motions; both for the exact motions and for their doubles. The two trees are walked once, with B swept
/// through the span: at t, B is displaced from where it is at the middle by (t - middle) times its points'
/// velocities there, and by no more than half of (t - middle)^2 times their accelerations. How A turns
/// meanwhile is allowed for in every direction. Returns false if there are more than `most` pairs, or it
/// takes too long to find them (`most` at kNoLimit: never).
bool find_swept_pairs(QueryContext& ctx, const MovingBody& a, const MovingBody& b, TimeSpan span,
                      std::uint64_t most, std::vector<SimplexPair>& pairs);

}  // namespace lrb
