#pragma once
/// An incremental convex hull with exact predicates.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

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

}  // namespace lrb::parting
