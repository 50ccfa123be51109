/// The expanding polytope algorithm (EPA; van den Bergen 2001) on the Minkowski difference of two convex
/// sets, with an exact convex hull as the polytope. Steps:
/// 1. Begin with a tetrahedron of support points.
/// 2. Take the facet nearest to the origin. The support point beyond it bounds the depth from above.
/// 3. If that point is beyond the facet's plane, add it to the polytope; otherwise the facet is final.
///    Repeat.
/// 4. The distance of the origin from the polytope's boundary is the lower bound, computed with proven
///    errors.

#include "engine/clash/minkowski.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/clash/clash_tolerances.hpp"
#include "engine/core/geometry.hpp"
#include "engine/distance/pair_bounds.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb {

const Vector3d& farthest(const ConvexPoints& points, const Vector3d& n) {
  const Vector3d* best = &points[0];
  double most = -kInfinity;
  // A linear scan; of equally distant points the first is returned.
  for (const Vector3d& x : points) {
    const double d = n.dot(x);
    if (d > most) {
      most = d;
      best = &x;
    }
  }
  return *best;
}

MinkowskiDifference::MinkowskiDifference(const ConvexPoints& a, const ConvexPoints& b) : a_(a), b_(b) {
  solid_ = begin();
}

Vector3d MinkowskiDifference::support(const Vector3d& n) const {
  // Support point of A - B: A's along n minus B's against n.
  return farthest(a_, n) - farthest(b_, -n);
}

bool MinkowskiDifference::begin() {
  const Vector3d first = support(Vector3d::UnitX());
  Vector3d second = first, third = first, fourth = first;
  const auto consider = [](Vector3d& best, double& most, const Vector3d& x, double value) {
    if (value > most) {
      most = value;
      best = x;
    }
  };
  double most = 0;
  // Second point: the farthest from the first among the support points of the six axis directions.
  for (int k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0}) {
      const Vector3d x = support(sign * Vector3d::Unit(k));
      consider(second, most, x, (x - first).norm());
    }
  // All six coincide: not a solid.
  if (!(most > 0)) return false;
  // Third point: the farthest from the line through both, in four directions normal to it.
  const Vector3d along = (second - first).normalized();
  const Vector3d across = along.unitOrthogonal(), other = along.cross(across);
  most = 0;
  for (const Vector3d& n : {across, other, Vector3d(-across), Vector3d(-other)}) {
    const Vector3d x = support(n);
    consider(third, most, x, along.cross(x - first).norm());
  }
  if (!(most > 0)) return false;
  // Fourth point: the farthest from the plane of the three, on either side.
  const Vector3d normal = along.cross(third - first).normalized();
  most = 0;
  for (const Vector3d& n : {normal, Vector3d(-normal)}) {
    const Vector3d x = support(n);
    consider(fourth, most, x, std::abs(normal.dot(x - first)));
  }
  // Decided exactly: false if rounding left the four points coplanar.
  return hull_.begin({first, second, third, fourth});
}

bool MinkowskiDifference::grow(std::size_t facet) {
  PointHull::Facet& f = hull_.facets()[facet];
  f.is_final = true;  // until it is replaced
  // A facet too thin for a normal cannot be improved.
  if (f.normal.isZero()) return false;
  // Support point beyond the facet: a translation by `width` along the normal separates the sets.
  const Vector3d x = support(f.normal);
  const double width = f.normal.dot(x);
  if (width < upper_) {
    upper_ = width;
    direction_ = f.normal;
  }
  // No gain beyond rounding: the facet is on the boundary of the Minkowski difference.
  return width - f.offset > kDepthGain && hull_.add(x);
}

unsigned MinkowskiDifference::find_depth(unsigned max_steps) {
  if (!solid_) return 0;
  unsigned step = 0;
  for (; step < max_steps && upper_ > 0; ++step) {
    // The nearest facet that is not final.
    const std::vector<PointHull::Facet>& facets = hull_.facets();
    std::size_t nearest = facets.size();
    for (std::size_t i = 0; i < facets.size(); ++i)
      if (!facets[i].is_final && (nearest == facets.size() || facets[i].offset < facets[nearest].offset))
        nearest = i;
    // Lower and upper bound agree up to kDepthGain: done.
    if (nearest == facets.size() || facets[nearest].offset >= upper_ - kDepthGain) break;
    grow(nearest);
  }
  return step;
}

double MinkowskiDifference::exit_of(const PointHull::Facet& f, const Vector3d& n) {
  // Ray against plane: without a positive slope the ray stays behind the facet.
  const double slope = f.normal.dot(n);
  return slope > 0 ? f.offset / slope : kInfinity;
}

void MinkowskiDifference::follow(const Vector3d& n) {
  if (!solid_) return;
  for (unsigned step = 0; step < kMaxDepthSteps; ++step) {
    const std::vector<PointHull::Facet>& facets = hull_.facets();
    // The facet through which the ray leaves the polytope.
    std::size_t first = 0;
    for (std::size_t i = 1; i < facets.size(); ++i)
      if (exit_of(facets[i], n) < exit_of(facets[first], n)) first = i;
    // Final, or no point beyond it: the polytope cannot expand there.
    if (facets[first].is_final || !grow(first)) return;
  }
}

/// The polytope's points have errors of up to kDifferenceRounding, so the true difference contains the
/// polytope except for a layer of this thickness.
double MinkowskiDifference::depth_lower() const {
  const Vector3d origin = Vector3d::Zero();
  // If the origin is not strictly inside, the sets need not overlap. Exact.
  if (!solid_ || !hull_.holds_inside(origin)) return 0;
  // The origin as a degenerate triangle, for the proven distance to each facet.
  const double* const point[3] = {origin.data(), origin.data(), origin.data()};
  double least = kInfinity;
  for (const PointHull::Facet& f : hull_.facets()) {
    const double* const corners[3] = {hull_.point(f.v[0]).data(), hull_.point(f.v[1]).data(),
                                      hull_.point(f.v[2]).data()};
    const double distance = bound_distance(point, corners, 3).lower;
    // Doubles cannot separate the origin from the facet.
    if (!(distance > 0)) return 0;
    least = std::min(least, distance);
  }
  return std::max(0.0, least - kDifferenceRounding);
}

/// Let the polytope P contain x = s n and a ball of radius r around the origin, and let e be
/// kDifferenceRounding. The true difference contains (1 - e / r) P: its support function is at least P's less
/// e, and P's is at least r.
double MinkowskiDifference::along_lower(const Vector3d& n) const {
  const double radius = depth_lower();
  if (!(radius > 0)) return 0;
  // The exit point of the ray from the polytope, rounded.
  double exit = kInfinity;
  for (const PointHull::Facet& f : hull_.facets()) exit = std::min(exit, exit_of(f, n));
  if (!(exit < kInfinity)) return 0;
  const double lost = kDifferenceRounding / radius;
  // Step back by increasing amounts, until the point is exactly inside the polytope.
  for (double share = kDepthGain; share < 1; share *= 4) {
    const double s = exit * (1 - share);
    const Vector3d x = s * n;
    // x is rounded as well, which the last term covers.
    if (hull_.holds_inside(x)) return std::max(0.0, s * (1 - 2 * lost) - 2 * kDifferenceRounding);
  }
  return 0;
}

// Incremental convex hull (beneath-beyond) with the exact orient3d: a new point replaces the facets visible
// from it by a cone over their horizon. Each insertion tests all facets.

int PointHull::side(const Facet& f, const Vector3d& x) const {
  return exact::orient3d(points_[f.v[0]].data(), points_[f.v[1]].data(), points_[f.v[2]].data(), x.data());
}

void PointHull::add_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  Facet f{{a, b, c}};
  // Normal and offset are rounded: they guide the search, and side() decides.
  const Vector3d n = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
  f.normal = n.stableNormalized();
  f.offset = f.normal.dot(points_[a]);
  facets_.push_back(f);
}

bool PointHull::begin(const std::array<Vector3d, 4>& corners) {
  points_.assign(corners.begin(), corners.end());
  facets_.clear();
  // Orient the tetrahedron so that all facets are counter-clockwise seen from outside.
  const int turn =
      exact::orient3d(corners[0].data(), corners[1].data(), corners[2].data(), corners[3].data());
  if (turn == 0) return false;
  if (turn > 0) std::swap(points_[1], points_[2]);  // now 3 is behind 0, 1, 2
  add_facet(0, 1, 2);
  add_facet(0, 3, 1);
  add_facet(1, 3, 2);
  add_facet(2, 3, 0);
  return true;
}

bool PointHull::add(const Vector3d& point) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  // Visible facets are moved to the end. Coplanar ones count as not visible.
  const auto seen =
      std::partition(facets_.begin(), facets_.end(), [&](const Facet& f) { return side(f, point) <= 0; });
  if (seen == facets_.end()) return false;
  // Directed edges of these facets: an edge between two of them occurs in both directions.
  for (auto f = seen; f != facets_.end(); ++f)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({f->v[k], f->v[(k + 1) % 3]});
  facets_.erase(seen, facets_.end());
  std::sort(edges.begin(), edges.end());
  const auto last = static_cast<std::uint32_t>(points_.size());
  points_.push_back(point);
  // The others form the horizon: connect each with the new point.
  for (const auto& e : edges)
    if (!std::binary_search(edges.begin(), edges.end(), std::array<std::uint32_t, 2>{e[1], e[0]}))
      add_facet(e[0], e[1], last);
  return true;
}

bool PointHull::holds_inside(const Vector3d& point) const {
  // Strictly behind every facet.
  return std::all_of(facets_.begin(), facets_.end(), [&](const Facet& f) { return side(f, point) < 0; });
}

}  // namespace lrb
