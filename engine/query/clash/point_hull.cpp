/// Incremental convex hull (beneath-beyond) with the exact orient3d: a new point replaces the facets that it
/// sees by a cone over their horizon. Each insertion tests all facets.

#include "engine/query/clash/point_hull.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/exact/predicates.hpp"

namespace lrb::parting {

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
  // Orient the tetrahedron, so that all facets are counter-clockwise seen from outside.
  const int turn =
      exact::orient3d(corners[0].data(), corners[1].data(), corners[2].data(), corners[3].data());
  if (turn == 0) return false;
  if (turn > 0) std::swap(points_[1], points_[2]);  // now 3 lies behind 0, 1, 2
  add_facet(0, 1, 2);
  add_facet(0, 3, 1);
  add_facet(1, 3, 2);
  add_facet(2, 3, 0);
  return true;
}

bool PointHull::add(const Vector3d& point) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  // Facets that see the point are moved to the end. Coplanar ones count as behind.
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

}  // namespace lrb::parting
