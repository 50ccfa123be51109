/// Separating axis test (Gottschalk, Lin and Manocha, "OBBTree", 1996, for boxes; Ericson, "Real-Time
/// Collision Detection", 2005, for triangles) with a margin: the projections onto some direction must be
/// further apart than the margin.

#include "engine/query/coarse/separating_slab.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

Corners relative_to(const double* origin, const double* const x[3], int dim) {
  Corners c;
  for (int k = 0; k < 3; ++k) {
    const double* p = x[dim == 2 && k == 2 ? 1 : k];
    c[k] = {p[0] - origin[0], p[1] - origin[1], dim == 3 ? p[2] - origin[2] : 0};
  }
  return c;
}

/// Searches for a slab between two simplices. Any direction may be tried, however inaccurate it is.
class SlabSearch {
 public:
  SlabSearch(int dim, const Corners& a, const Corners& b, double margin)
      : dim_(dim), a_(a), b_(b), margin_(margin) {}

  int directions() const { return dim_ == 3 ? 21 : 7; }

  /// Returns true if there is a slab wider than the margin across a direction.
  bool parts(int direction) const {
    const Vector3d d = dim_ == 3 ? in_space(direction) : in_plane(direction);
    const double length_sq = d.squaredNorm();
    // A direction that vanishes, underflows or overflows proves nothing.
    if (!std::isnormal(length_sq)) return false;
    const double least = margin_ * std::sqrt(length_sq);
    if (!std::isnormal(least)) return false;
    // Project all corners; the wider gap between the two intervals counts, whichever body comes first.
    const double a0 = d.dot(a_[0]), a1 = d.dot(a_[1]), a2 = d.dot(a_[2]);
    const double b0 = d.dot(b_[0]), b1 = d.dot(b_[1]), b2 = d.dot(b_[2]);
    const double w = std::max(std::min({b0, b1, b2}) - std::max({a0, a1, a2}),
                              std::min({a0, a1, a2}) - std::max({b0, b1, b2}));
    // Both sides are scaled by |d|: no division is needed.
    return w > least;
  }

 private:
  static Vector3d edge(const Corners& c, int k) { return c[(k + 1) % 3] - c[k]; }
  static Vector3d normal(const Corners& c) { return edge(c, 0).cross(edge(c, 1)); }
  Vector3d middles() const { return (b_[0] + b_[1] + b_[2]) - (a_[0] + a_[1] + a_[2]); }

  /// Returns a direction to try: 0 the line between the centroids, 1-2 normals, 3-11 edge x edge, 12-17 in
  /// each plane across its edges, 18-20 the axes.
  Vector3d in_space(int i) const {
    // Face normals and edge x edge are complete for disjoint triangles in general position; the rest are for
    // coplanar and degenerate ones.
    if (i == 0) return middles();
    if (i < 3) return normal(i == 1 ? a_ : b_);
    if (i < 12) return edge(a_, (i - 3) / 3).cross(edge(b_, (i - 3) % 3));
    if (i < 15) return normal(a_).cross(edge(a_, i - 12));
    if (i < 18) return normal(b_).cross(edge(b_, i - 15));
    return Vector3d::Unit(i - 18);
  }
  Vector3d in_plane(int i) const {
    if (i == 0) return middles();
    if (i > 4) return Vector3d::Unit(i - 5);
    // 1 and 2: across each segment; 3 and 4: along it, for collinear ones.
    const Vector3d e = edge(i % 2 != 0 ? a_ : b_, 0);
    return i < 3 ? Vector3d(-e.y(), e.x(), 0) : e;
  }

  int dim_;
  const Corners &a_, &b_;
  double margin_;
};

}  // namespace

bool separated_by(double margin, int dim, const double* const a[3], const double* const b[3]) {
  // Differences of nearby coordinates lose few digits, wherever in the world the simplices are.
  const Corners x = relative_to(a[0], a, dim), y = relative_to(a[0], b, dim);
  const SlabSearch search(dim, x, y, margin);
  // One direction is a proof. The margin is far larger than the rounding of the projections.
  for (int i = 0; i < search.directions(); ++i)
    if (search.parts(i)) return true;
  return false;
}

}  // namespace lrb
