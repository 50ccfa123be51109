#include "engine/query/clash/inner_convex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include "engine/core/clash_tolerances.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include "engine/query/clash/point_hull.hpp"

namespace lrb::parting {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vector3d nearest_point(const Vector3d& x, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const SimplexPoint p = nearest_on_triangle(x, a, b, c);
  return p.weight[0] * a + p.weight[1] * b + p.weight[2] * c;
}

/// Planes, each with what of the convex set reaches furthest.
class Planes {
 public:
  Planes(const UnitBody& body, const ConvexPoints& set) : body_(body), set_(set) {}

  void add(const Vector3d& normal) {
    double most = -kInfinity;
    for (const Vector3d& x : set_) most = std::max(most, normal.dot(x));
    planes_.push_back({normal, most + kConvexMargin * normal.cwiseAbs().sum()});
  }
  std::size_t size() const { return planes_.size(); }

  /// Returns how far a triangle lies beyond a plane; proved to do so if positive.
  double beyond(std::size_t plane, const std::array<std::uint32_t, 3>& triangle) const {
    double least = kInfinity;
    for (const std::uint32_t v : triangle)
      least = std::min(least, planes_[plane].normal.dot(body_.points[v]));
    return least - planes_[plane].most;
  }

  /// Returns true if any of the planes, looked at from the last on, is proved to part a triangle from the
  /// set.
  bool part(const std::array<std::uint32_t, 3>& triangle) const {
    for (std::size_t i = planes_.size(); i-- > 0;)
      if (beyond(i, triangle) > 0) return true;
    return false;
  }

 private:
  struct Plane {
    Vector3d normal;
    double most;
  };
  const UnitBody& body_;
  const ConvexPoints& set_;
  std::vector<Plane> planes_;
};

Vector3d normal_of(const UnitBody& body, const std::array<std::uint32_t, 3>& t) {
  const Vector3d &a = body.points[t[0]], &b = body.points[t[1]], &c = body.points[t[2]];
  return (b - a).cross(c - a).stableNormalized();
}

ConvexPoints shrunk(const std::vector<Vector3d>& points, const Vector3d& centre, double share) {
  ConvexPoints out{centre};
  for (const Vector3d& x : points) out.push_back(centre + (1 - share) * (x - centre));
  return out;
}

/// Returns true if a triangle is far from being a face of a convex body: corners lie in front of it.
bool is_hollow(const UnitBody& body, const std::array<std::uint32_t, 3>& t) {
  const Vector3d &a = body.points[t[0]], &b = body.points[t[1]], &c = body.points[t[2]];
  const double area = (b - a).cross(c - a).norm();
  const double longest = std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
  if (!(area > kSliver * longest)) return false;
  const Vector3d n = normal_of(body, t);
  const double height = n.dot(a) + kHollow;
  return std::any_of(body.points.begin(), body.points.end(),
                     [&](const Vector3d& x) { return n.dot(x) > height; });
}

/// Proves that the surface does not enter the set, with the triangles' own planes, or those of others.
bool is_inside(const UnitBody& body, const ConvexPoints& set) {
  Planes planes(body, set);
  std::size_t hard = 0;
  std::vector<std::array<std::uint32_t, 3>> left;
  for (const auto& t : body.triangles) {
    if (planes.size() > 0 && planes.beyond(planes.size() - 1, t) > 0) continue;
    planes.add(normal_of(body, t));
    if (planes.beyond(planes.size() - 1, t) > 0) continue;
    left.push_back(t);
    if (++hard > kMostHardTriangles) return false;
  }
  return std::all_of(left.begin(), left.end(), [&](const auto& t) { return planes.part(t); });
}

/// A half-space n . (x - seed) <= offset; `first`: the offset that it began with.
struct HalfSpace {
  Vector3d normal;
  double offset, first;
};

class Inflation {
 public:
  Inflation(const UnitBody& body, const Vector3d& seed) : body_(body), seed_(seed) {}

  std::optional<ConvexPoints> run() {
    if (!bound_by_triangles()) return std::nullopt;
    const std::optional<std::vector<Vector3d>> corners = corners_of_intersection();
    if (!corners) return std::nullopt;
    for (const double share : kShrinks) {
      ConvexPoints set = shrunk(*corners, seed_, share);
      Planes planes(body_, set);
      for (const HalfSpace& h : half_spaces_) planes.add(h.normal);
      const bool proved = std::all_of(body_.triangles.begin(), body_.triangles.end(),
                                      [&](const auto& t) { return planes.part(t); });
      if (proved) return set;
    }
    return std::nullopt;
  }

 private:
  struct Near {
    double distance;
    Vector3d way;
    std::uint32_t triangle;
  };

  double least(const Vector3d& n, std::uint32_t triangle) const {
    double d = kInfinity;
    for (const std::uint32_t v : body_.triangles[triangle]) d = std::min(d, n.dot(body_.points[v] - seed_));
    return d;
  }

  bool bound_by_triangles() {
    std::vector<Near> near;
    for (std::uint32_t i = 0; i < body_.triangles.size(); ++i) {
      const auto& t = body_.triangles[i];
      const Vector3d way =
          nearest_point(seed_, body_.points[t[0]], body_.points[t[1]], body_.points[t[2]]) - seed_;
      near.push_back({way.norm(), way, i});
    }
    std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
    });
    for (const Near& n : near)
      if (!keep_out(n)) return false;
    return true;
  }

  /// Moves the half-space that a triangle costs least inward until the triangle lies beyond it, if that costs
  /// little; else adds one.
  bool keep_out(const Near& n) {
    if (!(n.distance > kLeastClearance)) return false;
    HalfSpace* best = nullptr;
    double best_offset = 0, best_share = kLittleLost;
    for (HalfSpace& h : half_spaces_) {
      const double offset = least(h.normal, n.triangle);
      if (offset >= h.offset) return true;
      if (offset > best_share * h.first) {
        best = &h;
        best_offset = offset;
        best_share = offset / h.first;
      }
    }
    if (best != nullptr) {
      best->offset = best_offset;
      return true;
    }
    if (half_spaces_.size() >= kMostHalfSpaces) return false;
    const Vector3d normal = n.way / n.distance;
    const double offset = std::min(least(normal, n.triangle), n.distance);
    if (!(offset > 0.5 * n.distance)) return false;
    half_spaces_.push_back({normal, offset, offset});
    return true;
  }

  /// Returns the corners of the intersection: the facets of the convex hull of the half-spaces' duals.
  std::optional<std::vector<Vector3d>> corners_of_intersection() const {
    std::vector<Vector3d> duals;
    for (const HalfSpace& h : half_spaces_) duals.push_back(h.normal / h.offset);
    for (int k = 0; k < 3; ++k)
      for (const double sign : {-1.0, 1.0}) duals.push_back(sign * Vector3d::Unit(k) / kUnitReach);
    PointHull hull;
    // The duals of a box hold the origin; a tetrahedron of four of them is no plane.
    const std::size_t n = duals.size();
    if (!hull.begin({duals[n - 6], duals[n - 5], duals[n - 4], duals[n - 2]})) return std::nullopt;
    for (const Vector3d& y : duals) hull.add(y);
    std::vector<Vector3d> corners;
    for (const PointHull::Facet& f : hull.facets()) {
      if (!(f.offset > 0)) return std::nullopt;
      corners.push_back(seed_ + f.normal / f.offset);
    }
    return corners;
  }

  const UnitBody& body_;
  const Vector3d seed_;
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace

std::optional<ConvexPoints> shrunken_body(const UnitBody& body, const Vector3d& inside) {
  if (static_cast<double>(body.points.size()) * static_cast<double>(body.triangles.size()) > kMostConvexWork)
    return std::nullopt;
  for (const auto& t : body.triangles)
    if (is_hollow(body, t)) return std::nullopt;
  for (const double share : kShrinks) {
    ConvexPoints set = shrunk(body.points, inside, share);
    if (is_inside(body, set)) return set;
  }
  return std::nullopt;
}

std::optional<ConvexPoints> convex_about(const UnitBody& body, const Vector3d& inside) {
  return Inflation(body, inside).run();
}

double rough_clearance(const UnitBody& body, const Vector3d& x) {
  double least = kInfinity;
  for (const auto& t : body.triangles)
    least = std::min(
        least, (nearest_point(x, body.points[t[0]], body.points[t[1]], body.points[t[2]]) - x).squaredNorm());
  return std::sqrt(least);
}

}  // namespace lrb::parting
