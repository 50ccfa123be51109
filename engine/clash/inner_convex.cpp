/// Convex sets inside a body, with proofs. Steps of convex_about() (Deits and Tedrake 2015, without
/// ellipsoids):
/// 1. Place a plane in front of the surface point that is nearest to the seed and not excluded yet; repeat.
/// 2. Intersect the half-spaces: by duality their vertices are the facets of a convex hull.
/// 3. Shrink the set towards the seed until every triangle is proven to be beyond a plane that has the set
///    behind it.
/// shrunken_body() begins with step 3, for bodies that are convex themselves.

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/clash/clash_parts.hpp"
#include "engine/clash/clash_tolerances.hpp"
#include "engine/clash/minkowski.hpp"
#include "engine/core/geometry.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include <lrbscope/core/polygon.hpp>

namespace lrb {
namespace {

Vector3d nearest_point(const Vector3d& x, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const SimplexPoint p = nearest_on_triangle(x, a, b, c);
  return p.weight[0] * a + p.weight[1] * b + p.weight[2] * c;
}

using Corners = std::array<Vector3d, 3>;

/// Supporting planes of a convex set, as candidates for separating planes.
class Planes {
 public:
  explicit Planes(const ConvexPoints& set) : set_(set) {}

  void add(const Vector3d& normal) { planes_.push_back(plane(normal)); }
  std::size_t size() const { return planes_.size(); }

  /// Returns true if the plane added last is proven to separate a triangle from the set.
  bool last_parts(const Corners& triangle) const { return beyond(planes_.back(), triangle) > 0; }
  /// Returns true if any of the planes is.
  bool part(const Corners& triangle) const {
    return std::any_of(planes_.begin(), planes_.end(),
                       [&](const Plane& p) { return beyond(p, triangle) > 0; });
  }
  /// Returns true if planes are proven to separate all parts of a triangle, which may be subdivided.
  /// Midpoints of edges are rounded by u / 2 each time; kConvexMargin allows for that.
  bool part_split(const Corners& x, unsigned depth) const {
    // Cheapest first: single planes, then combinations of two.
    if (part(x) || part_by_two(x)) return true;
    // No plane separates a corner that is behind all of them, however small the parts.
    if (depth == kMaxSplits || is_entered(x)) return false;
    // Four parts at the midpoints of the edges: each may be separated by a different plane.
    const Corners midpoint = {0.5 * (x[0] + x[1]), 0.5 * (x[1] + x[2]), 0.5 * (x[2] + x[0])};
    return part_split({x[0], midpoint[0], midpoint[2]}, depth + 1) &&
           part_split({midpoint[0], x[1], midpoint[1]}, depth + 1) &&
           part_split({midpoint[2], midpoint[1], x[2]}, depth + 1) &&
           part_split({midpoint[0], midpoint[1], midpoint[2]}, depth + 1);
  }

 private:
  struct Plane {
    Vector3d normal;
    double most;
  };
  Plane plane(const Vector3d& normal) const {
    double most = -kInfinity;
    // Support of the set, plus a margin that covers the rounding of both products.
    for (const Vector3d& x : set_) most = std::max(most, normal.dot(x));
    return {normal, most + kConvexMargin * normal.cwiseAbs().sum()};
  }

  /// Tries planes through the line in which two of the planes intersect. A triangle beyond that line may be
  /// partly behind either of them.
  bool part_by_two(const Corners& x) const {
    for (std::size_t i = 0; i < planes_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double low = 0, high = 1;  // range of the first normal's weight for which all corners are beyond
        // Each corner limits the weights for which it is beyond the combined plane.
        for (const Vector3d& corner : x) {
          const double a = planes_[i].normal.dot(corner) - planes_[i].most;
          const double b = planes_[j].normal.dot(corner) - planes_[j].most;
          // Behind both planes, and so behind every combination.
          if (a <= 0 && b <= 0) low = 2;
          if (a > 0 && b <= 0) low = std::max(low, b / (b - a));
          if (a <= 0 && b > 0) high = std::min(high, b / (b - a));
        }
        if (!(low < high)) continue;
        const double share = 0.5 * (low + high);
        // The offset of the combined plane is recomputed, so that the proof does not depend on the rounding
        // of the weights.
        if (beyond(plane(share * planes_[i].normal + (1 - share) * planes_[j].normal), x) > 0) return true;
      }
    return false;
  }

  static double beyond(const Plane& plane, const Corners& triangle) {
    double least = kInfinity;
    for (const Vector3d& x : triangle) least = std::min(least, plane.normal.dot(x));
    return least - plane.most;
  }
  /// Returns true if a corner is behind all planes: subdivision does not help.
  bool is_entered(const Corners& triangle) const {
    return std::any_of(triangle.begin(), triangle.end(), [&](const Vector3d& x) {
      return std::none_of(planes_.begin(), planes_.end(),
                          [&](const Plane& p) { return p.normal.dot(x) > p.most; });
    });
  }

  const ConvexPoints& set_;
  std::vector<Plane> planes_;
};

Vector3d normal_of(const UnitBody& body, const std::array<std::uint32_t, 3>& t) {
  const Vector3d &a = body.points[t[0]], &b = body.points[t[1]], &c = body.points[t[2]];
  return (b - a).cross(c - a).stableNormalized();
}

ConvexPoints shrunk(const std::vector<Vector3d>& points, const Vector3d& centre, double share) {
  // The centre is a point of the set: its location inside the body is part of the proof.
  ConvexPoints out{centre};
  for (const Vector3d& x : points) out.push_back(centre + (1 - share) * (x - centre));
  return out;
}

/// Returns true if a triangle is clearly not a face of a convex body: vertices are in front of it.
bool is_hollow(const UnitBody& body, const std::array<std::uint32_t, 3>& t) {
  const Vector3d &a = body.points[t[0]], &b = body.points[t[1]], &c = body.points[t[2]];
  const double area = (b - a).cross(c - a).norm();
  const double longest = std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
  // The normal of a sliver is unreliable, so it is no evidence.
  if (!(area > kThinTriangle * longest)) return false;
  const Vector3d n = normal_of(body, t);
  const double height = n.dot(a) + kHollow;
  // A vertex clearly in front of a face contradicts convexity.
  return std::any_of(body.points.begin(), body.points.end(),
                     [&](const Vector3d& x) { return n.dot(x) > height; });
}

/// Proves that the surface does not enter the set, with the planes of the triangles themselves or of others.
bool is_inside(const UnitBody& body, const ConvexPoints& set) {
  Planes planes(set);
  std::vector<Corners> left;
  for (const auto& t : body.triangles) {
    const Corners corners = {body.points[t[0]], body.points[t[1]], body.points[t[2]]};
    // The plane that was added last may separate this triangle as well.
    if (planes.size() > 0 && planes.last_parts(corners)) continue;
    // Its own plane, which is a supporting plane of a convex body.
    planes.add(normal_of(body, t));
    if (planes.last_parts(corners)) continue;
    // Slivers have inaccurate normals: retried below with all planes, if there are few.
    left.push_back(corners);
    if (left.size() > kMaxHardTriangles) return false;
  }
  // Quadratic in the number of such triangles, hence the limit.
  return std::all_of(left.begin(), left.end(), [&](const Corners& x) { return planes.part(x); });
}

/// A half-space n . (x - seed) <= offset. `first`: its initial offset.
struct HalfSpace {
  Vector3d normal;
  double offset, first;
  bool is_nudged = false;  ///< moved once by the amount that rounding may require
};

/// A part of a triangle that is not excluded by any half-space yet, with its point nearest to the origin.
struct Part {
  ConvexPoints corners;
  Vector3d nearest{0, 0, 0};
  double distance_sq = kInfinity;

  explicit Part(ConvexPoints polygon) : corners(std::move(polygon)) {
    // A clipped part is a convex polygon: visit its triangle fan.
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      const Vector3d x = nearest_point(Vector3d::Zero(), corners[0], corners[i], corners[i + 1]);
      if (x.squaredNorm() < distance_sq) {
        distance_sq = x.squaredNorm();
        nearest = x;
      }
    }
  }
};

/// Clips a convex polygon to n . x <= most.
ConvexPoints clipped(const ConvexPoints& in, const Vector3d& n, double most) {
  ConvexPoints out;
  clip_polygon(
      in, [&](const Vector3d& x) { return most - n.dot(x); },
      [&](const Vector3d& x, std::size_t, bool, bool) { out.push_back(x); });
  return out;
}

/// Repeatedly places a plane in front of the surface point that is nearest to the seed and not excluded yet.
/// The planes depend on the surface alone, not on its triangulation.
class Inflation {
 public:
  Inflation(const UnitBody& body, const Vector3d& seed) : body_(body), seed_(seed) {
    // Coordinates are relative to the seed, which becomes the origin.
    for (const auto& t : body.triangles)
      parts_.emplace_back(
          ConvexPoints{body.points[t[0]] - seed, body.points[t[1]] - seed, body.points[t[2]] - seed});
  }

  std::optional<ConvexPoints> run(WholeTriangles whole) {
    // Planes in front of points: independent of the triangulation.
    if (bound_by_points())
      if (std::optional<ConvexPoints> set = proved_set()) return set;
    // Planes in front of entire triangles: smaller sets, but easier proofs.
    if (whole == WholeTriangles::no) return std::nullopt;
    half_spaces_.clear();
    return bound_by_triangles() ? proved_set() : std::nullopt;
  }

 private:
  struct Near {
    double distance;
    Vector3d direction;
    std::uint32_t triangle;
  };

  bool bound_by_points() {
    // Each plane excludes at least the nearest point; the number of planes is limited.
    while (!parts_.empty())
      if (!put_plane()) return false;
    return true;
  }

  /// Returns the intersection of the half-spaces, shrunk until it is proven to be inside, or nullopt.
  std::optional<ConvexPoints> proved_set() const {
    const std::optional<std::vector<Vector3d>> corners = corners_of_intersection();
    if (!corners) return std::nullopt;
    // Try increasing shares of shrinking until every triangle is separated from the set.
    for (const double share : kShrinks) {
      ConvexPoints set = shrunk(*corners, seed_, share);
      Planes planes(set);
      for (const HalfSpace& h : half_spaces_) planes.add(h.normal);
      const bool proved = std::all_of(body_.triangles.begin(), body_.triangles.end(), [&](const auto& t) {
        return planes.part_split({body_.points[t[0]], body_.points[t[1]], body_.points[t[2]]}, 0);
      });
      if (proved) return set;
    }
    return std::nullopt;
  }

  /// Excludes the nearest point: moves a plane inward if that costs little, otherwise adds one. A plane that
  /// moves by more than rounding moves by the maximum that may be lost, because further moves would follow.
  bool put_plane() {
    // The point of all remaining parts that is nearest to the seed.
    const Vector3d x = std::min_element(parts_.begin(), parts_.end(), [](const Part& p, const Part& q) {
                         return p.distance_sq < q.distance_sq;
                       })->nearest;
    const double distance = x.norm();
    // The surface is too close to the seed for any proof.
    if (!(distance > kMinClearance)) return false;
    // Select the plane that loses least, among those that keep the share kLittleLost of their first offset.
    HalfSpace* moved = nullptr;
    for (HalfSpace& h : half_spaces_) {
      const double offset = h.normal.dot(x);
      if (offset < kLittleLost * h.first ||
          (moved != nullptr && offset / h.first < moved->normal.dot(x) / moved->first))
        continue;
      moved = &h;
    }
    if (moved != nullptr) {
      // Points of a flat part of the surface differ by rounding: one small move covers all of them.
      const double nudged = moved->offset * (1 - kFlatShare);
      const bool is_rounding = !moved->is_nudged && moved->normal.dot(x) > nudged;
      moved->is_nudged |= is_rounding;
      moved->offset = is_rounding ? nudged : kLittleLost * moved->first * (1 - kClipShare);
    } else {
      // A new plane, normal to the direction of the nearest point.
      if (half_spaces_.size() >= kMaxHalfSpaces) return false;
      half_spaces_.push_back({x / distance, distance, distance, false});
      moved = &half_spaces_.back();
    }
    // Remove the excluded parts, with a tolerance, so that points on the plane are removed as well.
    const double most = moved->offset * (1 - kClipShare);
    std::erase_if(parts_, [&](Part& part) {
      const bool is_behind = std::all_of(part.corners.begin(), part.corners.end(),
                                         [&](const Vector3d& y) { return moved->normal.dot(y) <= most; });
      if (!is_behind) part = Part(clipped(part.corners, moved->normal, most));
      // Fewer than three corners have no area.
      return part.corners.size() < 3;
    });
    return true;
  }

  double least(const Vector3d& n, std::uint32_t triangle) const {
    double d = kInfinity;
    for (const std::uint32_t v : body_.triangles[triangle]) d = std::min(d, n.dot(body_.points[v] - seed_));
    return d;
  }

  /// Bounds the set triangle by triangle, each as a whole. The sets are smaller and depend on the
  /// triangulation, but some proofs succeed only this way.
  bool bound_by_triangles() {
    // Triangles by distance from the seed: near ones determine the planes, which often exclude far ones as
    // well.
    std::vector<Near> near;
    for (std::uint32_t i = 0; i < body_.triangles.size(); ++i) {
      const auto& t = body_.triangles[i];
      const Vector3d direction =
          nearest_point(seed_, body_.points[t[0]], body_.points[t[1]], body_.points[t[2]]) - seed_;
      near.push_back({direction.norm(), direction, i});
    }
    // Ties by index, for a deterministic order.
    std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
    });
    for (const Near& n : near)
      if (!keep_out(n)) return false;
    return true;
  }

  /// Excludes a triangle: moves the half-space that loses least inward if the loss is small, otherwise adds a
  /// half-space.
  bool keep_out(const Near& n) {
    if (!(n.distance > kMinClearance)) return false;
    HalfSpace* best = nullptr;
    double best_offset = 0, best_share = kLittleLost;
    for (HalfSpace& h : half_spaces_) {
      const double offset = least(h.normal, n.triangle);
      // Excluded already.
      if (offset >= h.offset) return true;
      // Relative loss: the new offset as a share of the first one.
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
    if (half_spaces_.size() >= kMaxHalfSpaces) return false;
    const Vector3d normal = n.direction / n.distance;
    // In front of the entire triangle: by rounding a corner may be nearer than the nearest point.
    const double offset = std::min(least(normal, n.triangle), n.distance);
    // The direction is inaccurate because of rounding.
    if (!(offset > 0.5 * n.distance)) return false;
    half_spaces_.push_back({normal, offset, offset, false});
    return true;
  }

  /// Returns the vertices of the intersection of the half-spaces: the facets of the convex hull of their dual
  /// points.
  std::optional<std::vector<Vector3d>> corners_of_intersection() const {
    std::vector<Vector3d> duals;
    // A half-space n . x <= d that contains the origin has the dual point n / d.
    for (const HalfSpace& h : half_spaces_) duals.push_back(h.normal / h.offset);
    // A box that contains everything bounds the intersection.
    for (int k = 0; k < 3; ++k)
      for (const double sign : {-1.0, 1.0}) duals.push_back(sign * Vector3d::Unit(k) / kUnitReach);
    PointHull hull;
    // The origin is inside the duals of a box. Four of them, -x, +x, -y and -z, are not coplanar.
    const std::size_t n = duals.size();
    if (!hull.begin({duals[n - 6], duals[n - 5], duals[n - 4], duals[n - 2]})) return std::nullopt;
    // Exact insertion; duals of redundant half-spaces are inside and change nothing.
    for (const Vector3d& y : duals) hull.add(y);
    std::vector<Vector3d> corners;
    for (const PointHull::Facet& f : hull.facets()) {
      // The hull does not enclose the origin: the intersection would be unbounded.
      if (!(f.offset > 0)) return std::nullopt;
      // A facet's plane n . y = d is dual to the vertex n / d.
      corners.push_back(seed_ + f.normal / f.offset);
    }
    return corners;
  }

  const UnitBody& body_;
  const Vector3d seed_;
  std::vector<Part> parts_;  ///< relative to the seed
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace

std::optional<ConvexPoints> shrunken_body(const UnitBody& body, const Vector3d& inside) {
  // Skip large bodies: the running time is quadratic.
  if (static_cast<double>(body.points.size()) * static_cast<double>(body.triangles.size()) > kMaxConvexWork)
    return std::nullopt;
  // Reject bodies that are clearly not convex, before the expensive proof.
  for (const auto& t : body.triangles)
    if (is_hollow(body, t)) return std::nullopt;
  // The least share for which the proof succeeds yields the largest set.
  for (const double share : kShrinks) {
    ConvexPoints set = shrunk(body.points, inside, share);
    if (is_inside(body, set)) return set;
  }
  return std::nullopt;
}

std::optional<ConvexPoints> convex_about(const UnitBody& body, const Vector3d& inside, WholeTriangles whole) {
  return Inflation(body, inside).run(whole);
}

}  // namespace lrb
