#pragma once
/// An incremental convex hull with exact predicates.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "engine/clash/clash_parts.hpp"

namespace lrb::parting {

class PointHull {
 public:
  using Vector3d = Eigen::Vector3d;

  struct Facet {
    std::array<std::uint32_t, 3> v;  ///< counter-clockwise, seen from outside
    Vector3d normal{0, 0, 0};        ///< about unit; zero where rounding leaves none
    double offset = 0;               ///< about normal . x on the facet
    bool is_final = false;           ///< nothing is known to lie beyond it
  };

  /// Begins with a tetrahedron. Returns false if its corners are coplanar.
  bool begin(const std::array<Vector3d, 4>& corners);
  /// Adds a point: each facet that it is strictly in front of is replaced. A point on a facet's plane counts
  /// as behind it. No new facet is degenerate: were the point collinear with an edge of the horizon, it would
  /// be on the plane of the visible facet at that edge. Returns false if no facet sees the point.
  bool add(const Vector3d& point);
  /// Returns true if the point lies strictly inside, exactly.
  bool holds_inside(const Vector3d& point) const;

  std::vector<Facet>& facets() { return facets_; }
  const std::vector<Facet>& facets() const { return facets_; }
  const Vector3d& point(std::uint32_t i) const { return points_[i]; }
  std::size_t point_count() const { return points_.size(); }

 private:
  void add_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  int side(const Facet& f, const Vector3d& x) const;

  std::vector<Vector3d> points_;
  std::vector<Facet> facets_;
};

// The penetration depth of two convex sets.

/// The Minkowski difference A - B of two convex sets: the differences p - q of their points. The interiors of
/// A and of B moved by d overlap exactly if d is inside it. An inner polytope is known, which grows where its
/// boundary is nearest to the origin (EPA: van den Bergen, "Proximity Queries and Penetration Depth
/// Computation on 3D Game Objects", 2001, but with an exact hull and proven bounds).
class MinkowskiDifference {
 public:
  MinkowskiDifference(const ConvexPoints& a, const ConvexPoints& b);

  /// Grows the hull until the distance of the origin to its boundary is that of the Minkowski difference, or
  /// for `most_steps` steps. Continues earlier calls. Returns the number of steps.
  unsigned find_depth(unsigned most_steps);
  /// Grows the hull where the ray from the origin in direction `n` leaves it.
  void follow(const Vector3d& n);

  /// Returns a proven lower bound on the penetration depth, the least length of a translation of B after
  /// which the interiors do not overlap; 0 if they need not overlap now.
  double depth_lower() const;
  /// Returns a proven s such that the interiors overlap after all translations by less than s times `n`,
  /// which is at most 1 long; 0 if they need not overlap now.
  double along_lower(const Vector3d& n) const;

  /// Return the direction of the shortest separating translation of B that was found, and its length,
  /// rounded; infinite if there is none.
  const Vector3d& direction() const { return direction_; }
  double depth_upper() const { return upper_; }
  /// Returns approximately how far B must move along a unit direction until a plane separates the sets.
  double width(const Vector3d& n) const;

 private:
  Vector3d support(const Vector3d& n) const;
  bool begin();
  bool grow(std::size_t facet);
  /// Returns the parameter at which the ray from the origin in direction `n` leaves a facet's half-space;
  /// infinite if it does not.
  static double exit_of(const PointHull::Facet& f, const Vector3d& n);

  const ConvexPoints &a_, &b_;
  PointHull hull_;
  bool solid_ = false;
  Vector3d direction_{0, 0, 0};
  double upper_ = std::numeric_limits<double>::infinity();
};

}  // namespace lrb::parting
