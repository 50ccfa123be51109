#include "engine/query/clash/inner_convex.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/core/clash_tolerances.hpp"
#include "engine/core/infinity.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include "engine/query/clash/point_hull.hpp"

namespace lrb::parting {
namespace {

Vector3d nearest_point(const Vector3d& x, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const SimplexPoint p = nearest_on_triangle(x, a, b, c);
  return p.weight[0] * a + p.weight[1] * b + p.weight[2] * c;
}

using Corners = std::array<Vector3d, 3>;

/// Planes, each with what of the convex set reaches furthest.
class Planes {
 public:
  explicit Planes(const ConvexPoints& set) : set_(set) {}

  void add(const Vector3d& normal) { planes_.push_back(plane(normal)); }
  std::size_t size() const { return planes_.size(); }

  /// Returns true if the last of the planes is proved to part a triangle from the set.
  bool last_parts(const Corners& triangle) const { return beyond(planes_.back(), triangle) > 0; }
  /// Returns true if any of them is.
  bool part(const Corners& triangle) const {
    return std::any_of(planes_.begin(), planes_.end(),
                       [&](const Plane& p) { return beyond(p, triangle) > 0; });
  }
  /// Does the same for a triangle that may be divided. The middles of edges are rounded, by half of u each
  /// time; kConvexMargin has room for that.
  bool part_split(const Corners& x, unsigned depth) const {
    if (part(x) || part_by_two(x)) return true;
    if (depth == kMostSplits || is_entered(x)) return false;
    const Corners middle = {0.5 * (x[0] + x[1]), 0.5 * (x[1] + x[2]), 0.5 * (x[2] + x[0])};
    return part_split({x[0], middle[0], middle[2]}, depth + 1) &&
           part_split({middle[0], x[1], middle[1]}, depth + 1) &&
           part_split({middle[2], middle[1], x[2]}, depth + 1) &&
           part_split({middle[0], middle[1], middle[2]}, depth + 1);
  }

 private:
  struct Plane {
    Vector3d normal;
    double most;
  };
  Plane plane(const Vector3d& normal) const {
    double most = -kInfinity;
    for (const Vector3d& x : set_) most = std::max(most, normal.dot(x));
    return {normal, most + kConvexMargin * normal.cwiseAbs().sum()};
  }

  /// Tries planes between two of the planes, through the edge in which they meet: where the triangle lies
  /// beyond that edge, it may lie partly before either of them.
  bool part_by_two(const Corners& x) const {
    for (std::size_t i = 0; i < planes_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double low = 0, high = 1;  // shares of the first normal with which all corners lie beyond
        for (const Vector3d& corner : x) {
          const double a = planes_[i].normal.dot(corner) - planes_[i].most;
          const double b = planes_[j].normal.dot(corner) - planes_[j].most;
          if (a <= 0 && b <= 0) low = 2;
          if (a > 0 && b <= 0) low = std::max(low, b / (b - a));
          if (a <= 0 && b > 0) high = std::min(high, b / (b - a));
        }
        if (!(low < high)) continue;
        const double share = 0.5 * (low + high);
        if (beyond(plane(share * planes_[i].normal + (1 - share) * planes_[j].normal), x) > 0) return true;
      }
    return false;
  }

  static double beyond(const Plane& plane, const Corners& triangle) {
    double least = kInfinity;
    for (const Vector3d& x : triangle) least = std::min(least, plane.normal.dot(x));
    return least - plane.most;
  }
  /// Returns true if a corner lies behind all planes: no division helps.
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
  Planes planes(set);
  std::vector<Corners> left;
  for (const auto& t : body.triangles) {
    const Corners corners = {body.points[t[0]], body.points[t[1]], body.points[t[2]]};
    if (planes.size() > 0 && planes.last_parts(corners)) continue;
    planes.add(normal_of(body, t));
    if (planes.last_parts(corners)) continue;
    left.push_back(corners);
    if (left.size() > kMostHardTriangles) return false;
  }
  return std::all_of(left.begin(), left.end(), [&](const Corners& x) { return planes.part(x); });
}

/// A half-space n . (x - seed) <= offset; `first`: the offset that it began with.
struct HalfSpace {
  Vector3d normal;
  double offset, first;
  bool is_nudged = false;  ///< moved by as much as rounding may need, which happens once
};

/// A part of a triangle that no half-space has put outside yet.
using Part = std::vector<Vector3d>;

/// Returns the part of a polygon where n . x <= most.
Part clipped(const Part& in, const Vector3d& n, double most) {
  Part out;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Vector3d &x = in[i], &y = in[(i + 1) % in.size()];
    const double dx = most - n.dot(x), dy = most - n.dot(y);
    if (dx >= 0) out.push_back(x);
    if ((dx > 0 && dy < 0) || (dx < 0 && dy > 0)) out.push_back(x + dx / (dx - dy) * (y - x));
  }
  return out;
}

/// Puts a plane before what of the surface is nearest to the seed and not yet behind a plane, again and
/// again. Where the planes lie depends on the surface alone, not on how it is divided into triangles.
class Inflation {
 public:
  Inflation(const UnitBody& body, const Vector3d& seed) : body_(body), seed_(seed) {
    for (const auto& t : body.triangles)
      parts_.push_back({body.points[t[0]] - seed, body.points[t[1]] - seed, body.points[t[2]] - seed});
  }

  std::optional<ConvexPoints> run(WholeTriangles whole) {
    if (bound_by_points())
      if (std::optional<ConvexPoints> set = proved_set()) return set;
    if (whole == WholeTriangles::no) return std::nullopt;
    half_spaces_.clear();
    return bound_by_triangles() ? proved_set() : std::nullopt;
  }

 private:
  struct Near {
    double distance;
    Vector3d way;
    std::uint32_t triangle;
  };

  bool bound_by_points() {
    while (!parts_.empty())
      if (!put_plane()) return false;
    return true;
  }

  /// Returns the intersection of the half-spaces, shrunk until it is proved to lie inside.
  std::optional<ConvexPoints> proved_set() const {
    const std::optional<std::vector<Vector3d>> corners = corners_of_intersection();
    if (!corners) return std::nullopt;
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

  /// Returns the point of all parts that is nearest to the seed.
  Vector3d nearest() const {
    Vector3d best = Vector3d::Zero();
    double least = kInfinity;
    for (const Part& part : parts_)
      for (std::size_t i = 1; i + 1 < part.size(); ++i) {
        const Vector3d x = nearest_point(Vector3d::Zero(), part[0], part[i], part[i + 1]);
        if (x.squaredNorm() < least) {
          least = x.squaredNorm();
          best = x;
        }
      }
    return best;
  }

  /// Moves a plane inward where that costs little, else adds one. Where a plane is moved for anything but
  /// rounding it is moved by as much as may ever be lost, because more will follow.
  bool put_plane() {
    const Vector3d x = nearest();
    const double distance = x.norm();
    if (!(distance > kLeastClearance)) return false;
    HalfSpace* moved = nullptr;
    for (HalfSpace& h : half_spaces_) {
      const double offset = h.normal.dot(x);
      if (offset < kLittleLost * h.first ||
          (moved != nullptr && offset / h.first < moved->normal.dot(x) / moved->first))
        continue;
      moved = &h;
    }
    if (moved != nullptr) {
      const double nudged = moved->offset * (1 - kFlatShare);
      const bool is_rounding = !moved->is_nudged && moved->normal.dot(x) > nudged;
      moved->is_nudged |= is_rounding;
      moved->offset = is_rounding ? nudged : kLittleLost * moved->first * (1 - kClipShare);
    } else {
      if (half_spaces_.size() >= kMostHalfSpaces) return false;
      half_spaces_.push_back({x / distance, distance, distance, false});
      moved = &half_spaces_.back();
    }
    std::vector<Part> left;
    for (const Part& part : parts_) {
      Part inside = clipped(part, moved->normal, moved->offset * (1 - kClipShare));
      if (inside.size() >= 3) left.push_back(std::move(inside));
    }
    parts_ = std::move(left);
    return true;
  }

  double least(const Vector3d& n, std::uint32_t triangle) const {
    double d = kInfinity;
    for (const std::uint32_t v : body_.triangles[triangle]) d = std::min(d, n.dot(body_.points[v] - seed_));
    return d;
  }

  /// Does it triangle by triangle, each as a whole: finds smaller sets, which depend on the triangles, but
  /// proofs that the other way does not.
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
    half_spaces_.push_back({normal, offset, offset, false});
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
  std::vector<Part> parts_;  ///< seen from the seed
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

std::optional<ConvexPoints> convex_about(const UnitBody& body, const Vector3d& inside, WholeTriangles whole) {
  return Inflation(body, inside).run(whole);
}

}  // namespace lrb::parting
