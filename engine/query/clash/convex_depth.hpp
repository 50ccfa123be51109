#pragma once
/// How deep two convex sets overlap.

#include <limits>

#include "engine/query/clash/inner_convex.hpp"
#include "engine/query/clash/point_hull.hpp"

namespace lrb::parting {

/// The differences p - q of the points of two convex sets, A's and B's. The interiors of A and of B, moved by
/// d, overlap exactly if d is one of these differences and not on their boundary. What is known of them: the
/// hull of some, which grows where the boundary is nearest (as in van den Bergen, "Proximity Queries and
/// Penetration Depth Computation on 3D Game Objects", 2001, but with an exact hull and proved bounds).
class ConvexDifference {
 public:
  ConvexDifference(const ConvexPoints& a, const ConvexPoints& b);

  /// Grows the hull until the distance of the origin to its boundary is that of all differences, or for so
  /// many steps; goes on from where it was. Returns how many steps it took.
  unsigned find_depth(unsigned most_steps);
  /// Grows the hull where the ray from the origin in direction `n` leaves it.
  void follow(const Vector3d& n);

  /// Returns a proved lower bound of the depth, the least length of a translation of B after which the
  /// interiors do not overlap; 0 if they need not overlap now.
  double depth_lower() const;
  /// Returns a proved s such that the interiors overlap after all translations by less than s along `n`, at
  /// most 1 long; 0 if they need not overlap now. `way_out`: where the hull is about left.
  double along_lower(const Vector3d& n) const;

  /// Return the direction in which B leaves A after the least translation that was found, and the length of
  /// that, rounded; infinite if there is none.
  const Vector3d& direction() const { return direction_; }
  double depth_upper() const { return upper_; }
  /// Returns about how far B must move along a direction of length 1 until a plane parts the two.
  double width(const Vector3d& n) const;

 private:
  Vector3d support(const Vector3d& n) const;
  bool begin();
  bool grow(std::size_t facet);
  /// Returns how far the ray from the origin in direction `n` runs in a facet's half-space; infinite if it
  /// does not leave it.
  static double exit_of(const PointHull::Facet& f, const Vector3d& n);

  const ConvexPoints &a_, &b_;
  PointHull hull_;
  bool solid_ = false;
  Vector3d direction_{0, 0, 0};
  double upper_ = std::numeric_limits<double>::infinity();
};

}  // namespace lrb::parting
