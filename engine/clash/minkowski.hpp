#pragma once
/// An incremental convex hull with exact predicates.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "engine/clash/clash_parts.hpp"

namespace lrb {

class PointHull {
 public:
  using Vector3d = Eigen::Vector3d;

  struct Facet {
    std::array<std::uint32_t, 3> v;  ///< counter-clockwise, seen from outside
    Vector3d normal{0, 0, 0};        ///< approximately unit; zero if rounding leaves no direction
    double offset = 0;               ///< approximately normal . x on the facet
    bool is_final = false;           ///< no point beyond it is known
  };

  /// Begins with a tetrahedron. Returns false if its corners are coplanar.
  bool begin(const std::array<Vector3d, 4>& corners);
  /// Adds a point: each facet that has the point strictly in front of it is replaced. A point on a facet's
  /// plane counts as behind it. No new facet is degenerate: if the point were collinear with an edge of the
  /// horizon, it would be on the plane of the visible facet at that edge. Returns false if no facet is
  /// visible from the point.
  bool add(const Vector3d& point);
  /// Returns true if the point is strictly inside. Exact.
  bool holds_inside(const Vector3d& point) const;

  std::vector<Facet>& facets() { return facets_; }
  const std::vector<Facet>& facets() const { return facets_; }
  const Vector3d& point(std::uint32_t i) const { return points_[i]; }

 private:
  void add_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  int side(const Facet& f, const Vector3d& x) const;

  std::vector<Vector3d> points_;
  std::vector<Facet> facets_;
};

// The penetration depth of two convex sets.

/// Returns the first of the farthest points along n.
const Eigen::Vector3d& farthest(const ConvexPoints& points, const Eigen::Vector3d& n);

/// The Minkowski difference A - B of two convex sets: the differences p - q of their points. The interiors of
/// A and of B moved by d overlap if and only if d is inside it. An inner polytope is known, which is expanded
/// where its boundary is nearest to the origin (EPA: van den Bergen, "Proximity Queries and Penetration Depth
/// Computation on 3D Game Objects", 2001, but with an exact hull and proven bounds).
class MinkowskiDifference {
 public:
  MinkowskiDifference(const ConvexPoints& a, const ConvexPoints& b);

  /// Expands the polytope until the distance of the origin from its boundary equals the distance from the
  /// boundary of the Minkowski difference, or for `max_steps` steps. Continues earlier calls. Returns the
  /// number of steps.
  unsigned find_depth(unsigned max_steps);
  /// Expands the polytope where the ray from the origin in direction `n` leaves it.
  void follow(const Vector3d& n);

  /// Returns a proven lower bound on the penetration depth, the least length of a translation of B after
  /// which the interiors do not overlap, or 0 if no overlap is proven at the current poses.
  double depth_lower() const;
  /// Returns a proven s such that the interiors overlap after all translations by less than s times `n`, or 0
  /// if no overlap is proven at the current poses. `n`: at most of unit length.
  double along_lower(const Vector3d& n) const;

  /// Return the direction of the shortest separating translation of B found so far, and its length, rounded,
  /// or infinity if none was found.
  const Vector3d& direction() const { return direction_; }
  double depth_upper() const { return upper_; }

 private:
  Vector3d support(const Vector3d& n) const;
  bool begin();
  bool grow(std::size_t facet);
  /// Returns the parameter at which the ray from the origin in direction `n` leaves a facet's half-space, or
  /// infinity if it does not.
  static double exit_of(const PointHull::Facet& f, const Vector3d& n);

  const ConvexPoints &a_, &b_;
  PointHull hull_;
  bool solid_ = false;
  Vector3d direction_{0, 0, 0};
  double upper_ = std::numeric_limits<double>::infinity();
};

}  // namespace lrb
