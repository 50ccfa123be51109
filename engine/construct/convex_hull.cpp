// Exact convex hull of points in 3D by Quickhull (Barber, Dobkin and Huhdanpaa 1996), with symbolic
// perturbation:
// 1. Start with a tetrahedron of positive volume; assign every other point to one facet visible from it.
// 2. Take a facet with points; its furthest point p becomes a vertex of the hull.
// 3. Find the facets visible from p by a search over neighbours; its border is the horizon.
// 4. Connect p to every horizon edge, and reassign the points of the removed facets to the new ones.
// 5. Repeat from 2 until no facet has points. Points from which no facet is visible are inside and were
//    dropped.

#include "engine/construct/convex_hull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include <lrbscope/core/float_mode.hpp>

namespace lrb::construct {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Quickhull: each point that is still outside the hull is in the list of one facet visible from it. The
/// furthest point of a facet's list becomes a vertex, and the points of the replaced facets are
/// redistributed.
///
/// The order of insertion does not affect the result, because a symbolic perturbation leaves no four points
/// coplanar: each point is moved towards an interior point by an infinitesimal share of the distance, and
/// every point by infinitely more than those before it. So a point in the plane of earlier points is behind
/// that plane, as if the points were added in order. The hull of the perturbed points is unique.
class Hull {
 public:
  explicit Hull(std::span<const Eigen::Vector3d> points)
      : points_(points), next_(points.size(), kNull), facet_from_(points.size(), kNull) {}

  std::vector<Triangle> run() {
    // Without a tetrahedron of positive volume all points are coplanar, and there is no hull.
    if (!start()) return {};
    while (!pending_.empty()) {
      const std::uint32_t f = pending_.back();
      pending_.pop_back();
      // A facet can be listed and removed before its turn. Removed facets have no points left and are
      // skipped.
      if (facets_[f].waiting != kNull) add(facets_[f].furthest, f);
    }
    return in_order();
  }

 private:
  struct Facet {
    Triangle corners;
    exact::PlaneSide plane;
    /// The facet beyond the edge corners[i], corners[i + 1].
    std::array<std::uint32_t, 3> across = {kNull, kNull, kNull};
    std::uint32_t waiting = kNull;  ///< the first of the points in its list
    std::uint32_t furthest = kNull;
    double height = -std::numeric_limits<double>::infinity();  ///< height of the furthest point
    bool alive = true;
  };
  struct HorizonEdge {
    std::uint32_t a, b;    ///< in their order in the removed facet
    std::uint32_t beyond;  ///< the facet that remains
  };

  const double* at(std::uint32_t p) const { return points_[p].data(); }

  /// Makes the facets of a tetrahedron of positive volume. Returns false if all points are coplanar.
  bool start() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    std::uint32_t b = 1, c, d;
    // Grow a simplex by dimension: the first distinct point, the first off the line, the first off the plane.
    while (b < count && points_[b] == points_[0]) ++b;
    // All tests are exact, so the volume is positive however flat the tetrahedron is.
    for (c = b + 1; c < count && exact::collinear3d(at(0), at(b), at(c));) ++c;
    int side = 0;
    for (d = c + 1; d < count && (side = exact::orient3d(at(0), at(b), at(c), at(d))) == 0;) ++d;
    if (side == 0) return false;
    // Orient the base so that d is behind it. The other three facets then face outward as well.
    if (side > 0) std::swap(b, c);
    first_ = {0, b, c, d};
    for (const Triangle& t : {Triangle{0, b, c}, Triangle{0, d, b}, Triangle{b, d, c}, Triangle{c, d, 0}})
      make(t);
    // The adjacency of a tetrahedron, written out for these four vertex orders.
    facets_[0].across = {1, 2, 3};
    facets_[1].across = {3, 2, 0};
    facets_[2].across = {1, 3, 0};
    facets_[3].across = {2, 1, 0};
    // Initial partition of the points: 4 plane tests per point. Points inside the tetrahedron are dropped.
    for (std::uint32_t p = 0; p < count; ++p)
      if (!is_first(p)) wait(p);
    expect_points();
    return true;
  }

  bool is_first(std::uint32_t p) const { return std::find(first_.begin(), first_.end(), p) != first_.end(); }
  /// Returns a point's rank in the order of perturbation. The first four are never compared with each other.
  std::uint32_t rank(std::uint32_t p) const { return is_first(p) ? 0 : p + 1; }

  std::uint32_t make(const Triangle& t) {
    const Facet facet{t, exact::PlaneSide(at(t[0]), at(t[1]), at(t[2]))};
    std::uint32_t f;
    // Slots of removed facets are reused, so that memory stays linear in the size of the hull.
    if (free_.empty()) {
      f = static_cast<std::uint32_t>(facets_.size());
      facets_.push_back(facet);
    } else {
      f = free_.back();
      free_.pop_back();
      facets_[f] = facet;
    }
    made_.push_back(f);
    return f;
  }

  bool sees(std::uint32_t p, const Facet& f) const {
    // Filtered exact sign of the orientation; only coplanar points need the perturbation.
    const int side = f.plane.side(at(p));
    return side != 0 ? side > 0 : sees_in_plane(p, f.corners);
  }

  /// Returns true if t is visible from p, which is in the plane of t. Of the four points, the one with the
  /// largest perturbation decides. If that is p, it moves behind the plane. If it is a corner, the plane
  /// rotates about the opposite edge, and p is in front if it is on the corner's side of that edge; if p is
  /// on the edge's line, the point with the next largest perturbation decides.
  bool sees_in_plane(std::uint32_t p, const Triangle& t) const {
    // Later points move infinitely more, so their perturbations dominate: examine the corners from the last
    // to the first.
    std::array<int, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return rank(t[i]) > rank(t[j]); });
    for (const int k : order) {
      // Now p dominates. It moves inward, hence behind the plane.
      if (rank(t[k]) < rank(p)) return false;
      // Corner k dominates. Its motion tilts the plane about the opposite edge.
      const int side = side_of_edge(t[(k + 1) % 3], t[(k + 2) % 3], t[k], p);
      if (side != 0) return side > 0;
    }
    return false;
  }

  /// Returns, for four coplanar points, +1 if p and c are on the same side of the line a, b, -1 if they are
  /// on different sides, and 0 if p is on the line.
  int side_of_edge(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t p) const {
    // Project along a coordinate axis that keeps the triangle's area positive; signs in the projection decide
    // exactly.
    for (int x = 0; x < 3; ++x) {
      const int y = (x + 1) % 3;
      const int turn = exact::orient_axes(at(a), at(b), at(c), x, y);
      // The product of the two orientations is independent of the direction of projection.
      if (turn != 0) return turn * exact::orient_axes(at(a), at(b), at(p), x, y);
    }
    return 0;
  }

  /// Adds p to the list of the first new facet visible from it. If none is, p is inside: if a removed and a
  /// remaining facet are visible from a point, so is a new one between them.
  void wait(std::uint32_t p) {
    // One facet is enough: if it is removed, the point is redistributed.
    for (const std::uint32_t f : made_) {
      Facet& facet = facets_[f];
      if (!sees(p, facet)) continue;
      next_[p] = facet.waiting;
      facet.waiting = p;
      // Rounded heights choose the next vertex to insert. They affect the running time, not the hull.
      const double height = facet.plane.rough_height(at(p));
      if (facet.furthest == kNull || height > facet.height) {
        facet.furthest = p;
        facet.height = height;
      }
      return;
    }
  }

  void expect_points() {
    pending_.insert(pending_.end(), made_.begin(), made_.end());
    made_.clear();
  }

  /// Makes p a vertex. Facet f must be visible from p.
  void add(std::uint32_t p, std::uint32_t f) {
    // Step 1: the facets visible from p, and the horizon around them.
    find_visible(p, f);
    // Step 2: one new facet over each horizon edge, linked to the facet that remains beyond it.
    for (const HorizonEdge& e : horizon_) {
      const std::uint32_t n = make({e.a, e.b, p});
      facets_[n].across[0] = e.beyond;
      Facet& beyond = facets_[e.beyond];
      for (int i = 0; i < 3; ++i)
        // The edge runs b -> a in the facet beyond.
        if (beyond.corners[i] == e.b) beyond.across[i] = n;
      facet_from_[e.a] = n;
    }
    // Step 3: link neighbouring new facets. The horizon is a simple cycle, so its start vertices identify
    // them.
    for (const std::uint32_t n : made_) {
      const std::uint32_t following = facet_from_[facets_[n].corners[1]];
      facets_[n].across[1] = following;
      facets_[following].across[2] = n;
    }
    // Step 4: redistribute the points of the removed facets. Each point is tested against new facets only.
    for (const std::uint32_t v : visible_) {
      for (std::uint32_t q = facets_[v].waiting; q != kNull;) {
        // Read the link first: wait() overwrites it.
        const std::uint32_t following = next_[q];
        if (q != p) wait(q);
        q = following;
      }
      facets_[v].waiting = kNull;
    }
    // Slots are freed only now, so that they were not reused in between. The first four facets keep theirs,
    // because in_order() needs them.
    for (const std::uint32_t v : visible_)
      if (v >= first_.size()) free_.push_back(v);
    expect_points();
  }

  /// Finds the facets visible from p, which are connected, and marks them as removed.
  void find_visible(std::uint32_t p, std::uint32_t f) {
    // Breadth-first search. The visible facets are connected because the hull is convex.
    visible_ = {f};
    horizon_.clear();
    facets_[f].alive = false;
    for (std::size_t i = 0; i < visible_.size(); ++i) {
      const Facet& facet = facets_[visible_[i]];
      for (int k = 0; k < 3; ++k) {
        Facet& other = facets_[facet.across[k]];
        // Already found to be visible.
        if (!other.alive) continue;
        if (sees(p, other)) {
          other.alive = false;
          visible_.push_back(facet.across[k]);
        } else {
          // A visible facet next to an invisible one: their common edge is on the horizon.
          horizon_.push_back({facet.corners[k], facet.corners[(k + 1) % 3], facet.across[k]});
        }
      }
    }
  }

  /// Returns the triangles in the order of incremental insertion: the remaining ones of the first four
  /// facets, then by last corner and, for equal ones, by the edge before it.
  std::vector<Triangle> in_order() const {
    std::vector<Triangle> triangles;
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (!facets_[f].alive) continue;
      Triangle t = facets_[f].corners;
      if (f >= first_.size()) {
        // Every other facet was made by its last corner, with the horizon edge before it in front.
        const auto last = std::max_element(
            t.begin(), t.end(), [&](std::uint32_t u, std::uint32_t v) { return rank(u) < rank(v); });
        std::rotate(t.begin(), last + 1, t.end());
      }
      triangles.push_back(t);
    }
    // The remaining facets of the tetrahedron come first, in their own order.
    const auto of_first = std::count_if(facets_.begin(), facets_.begin() + first_.size(),
                                        [](const Facet& f) { return f.alive; });
    std::sort(triangles.begin() + of_first, triangles.end(), [](const Triangle& t, const Triangle& u) {
      return std::tie(t[2], t[0], t[1]) < std::tie(u[2], u[0], u[1]);
    });
    return triangles;
  }

  std::span<const Eigen::Vector3d> points_;
  std::array<std::uint32_t, 4> first_ = {};  ///< corners of the first four facets
  std::vector<Facet> facets_;                ///< slots; all but the first four are reused
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> pending_;  ///< slots of facets that may have points
  std::vector<std::uint32_t> made_;     ///< the facets made by the last vertex
  std::vector<std::uint32_t> visible_;
  std::vector<HorizonEdge> horizon_;
  std::vector<std::uint32_t> next_;        ///< (|points|) the next point in the list of the same facet
  std::vector<std::uint32_t> facet_from_;  ///< (|points|) new facet whose horizon edge starts here
};

}  // namespace
}  // namespace lrb::construct

namespace lrb {

std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const Eigen::Vector3d> points) {
  const FloatMode float_mode;
  if (points.size() < 4) return {};
  return construct::Hull(points).run();
}

Mesh convex_hull_mesh(std::span<const Eigen::Vector3d> points) {
  Mesh mesh;
  std::vector<VertexId> number(points.size(), kNull);
  for (const std::array<std::uint32_t, 3>& t : convex_hull(points)) {
    VertexId corners[3];
    for (int i = 0; i < 3; ++i) {
      // Number the vertices in the order of their first use; interior points get no number.
      VertexId& v = number[t[i]];
      if (v == kNull) {
        v = static_cast<VertexId>(mesh.vertices.size());
        mesh.vertices.push_back(points[t[i]]);
      }
      corners[i] = v;
    }
    mesh.add_face(corners);
  }
  return mesh;
}

std::vector<std::uint32_t> convex_outline(std::span<const Eigen::Vector3d> points) {
  const FloatMode float_mode;
  // Monotone chains (Andrew 1979).
  // Step 1: sort by x, then y, then index. Equal points become adjacent, and the lowest index remains.
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    const Eigen::Vector3d &a = points[i], &b = points[j];
    return a.x() != b.x() ? a.x() < b.x() : a.y() != b.y() ? a.y() < b.y() : i < j;
  };
  std::sort(order.begin(), order.end(), before);
  order.erase(std::unique(order.begin(), order.end(),
                          [&](std::uint32_t i, std::uint32_t j) {
                            return points[i].x() == points[j].x() && points[i].y() == points[j].y();
                          }),
              order.end());
  // Step 2: scan in order and remove the last point while it turns right. Straight angles are kept, because
  // callers need the points inside sides. Amortised O(1) per point.
  const auto chain = [&](auto first, auto last) {
    std::vector<std::uint32_t> out;
    for (auto i = first; i != last; ++i) {
      while (out.size() >= 2 && exact::orient2d(points[out[out.size() - 2]].data(), points[out.back()].data(),
                                                points[*i].data()) < 0)
        out.pop_back();
      out.push_back(*i);
    }
    return out;
  };
  // Step 3: the lower chain from left to right, the upper one from right to left: counter-clockwise together.
  std::vector<std::uint32_t> outline = chain(order.begin(), order.end());
  const std::vector<std::uint32_t> upper = chain(order.rbegin(), order.rend());
  // Collinear points never turn right, so both chains then contain all points.
  const bool flat = outline.size() == order.size() && upper.size() == order.size();
  if (flat || upper.size() < 2) return {};
  // The chains share their end points.
  outline.insert(outline.end(), upper.begin() + 1, upper.end() - 1);
  return outline;
}

}  // namespace lrb

namespace lrb::construct {

// Convex polygons in 2D.
// - enclosing_polygon(): move the convex outline of the points outward; then remove sides greedily, always
// the
//   one that adds the least area; finally confirm the result exactly, with a box as the fallback.

namespace {

using Vector3 = Eigen::Vector3d;

/// The intersection of two sides p0 -> p1 and q0 -> q1 when extended, and the area that this adds beyond p1,
/// q0; the area is infinite if they do not converge.
struct MeetingPoint {
  Vector3 x;
  double area;
};

MeetingPoint meet(const Vector3& p0, const Vector3& p1, const Vector3& q0, const Vector3& q1) {
  const Vector3 p = p1 - p0, q = q1 - q0;
  // Extended beyond p1 and q0, the sides converge if and only if they turn left by less than 180 degrees.
  const double turn = cross_2d(p, q);
  if (!(turn > 0)) return {p1, std::numeric_limits<double>::infinity()};
  // Cramer's rule. The area is twice that of the triangle q0, p1, x; it is only compared.
  const Vector3 x = p1 + p * (cross_2d(q0 - p1, q) / turn);
  return {x, cross_2d(p1 - q0, x - q0)};
}

}  // namespace

std::vector<Vector3> enclosing_polygon(std::span<const Vector3> points, std::uint32_t max_sides,
                                       double distance) {
  // The fallback: the bounding box, grown by the distance. Reject coordinates whose products would overflow.
  Eigen::AlignedBox3d box;
  for (const Vector3& p : points) box.extend(p);
  distance *= box.sizes().maxCoeff();
  const Vector3 low = box.min().array() - distance, high = box.max().array() + distance;
  const double width = high.x() - low.x(), height = high.y() - low.y();
  if (!std::isfinite(width * height * width * height)) return {};
  // Minkowski sum with a square of four points on the axes: its inradius is distance / sqrt(2), so that every
  // point keeps half of the distance even after rounding.
  std::vector<Vector3> around;
  for (const Vector3& p : points)
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{-1, 0}, std::pair{0, -1}})
      around.emplace_back(p.x() + distance * dx, p.y() + distance * dy, 0);
  std::vector<Vector3> polygon;
  for (const std::uint32_t i : convex_outline(around)) polygon.push_back(around[i]);
  // Remove one side per round: O(n^2) for n sides of the hull, which is small compared to the mesh.
  while (polygon.size() > std::max(max_sides, 4u)) {
    const std::size_t n = polygon.size();
    std::size_t best = 0;
    MeetingPoint least{Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < n; ++i) {  // remove the side from i + 1 to i + 2
      // Its neighbours are extended to their intersection, which replaces both of its ends.
      const MeetingPoint c =
          meet(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n], polygon[(i + 3) % n]);
      if (c.area < least.area) {
        least = c;
        best = i;
      }
    }
    // No two sides converge, as in a parallelogram.
    if (!std::isfinite(least.area)) break;
    // The new corner replaces the side's first end; its second end is erased.
    polygon[(best + 1) % n] = least.x;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>((best + 2) % n));
  }
  // The intersections are rounded. Confirm exactly that all points are strictly inside, otherwise use the
  // box.
  const auto is_good = [&] {
    return polygon.size() <= std::max(max_sides, 4u) &&
           std::all_of(points.begin(), points.end(), [&](const Vector3& p) { return holds_2d(polygon, p); });
  };
  if (!is_good())
    polygon = {
        {low.x(), low.y(), 0}, {high.x(), low.y(), 0}, {high.x(), high.y(), 0}, {low.x(), high.y(), 0}};
  return polygon;
}

bool holds_2d(std::span<const Vector3> polygon, const Vector3& point) {
  // Strictly to the left of every side. Linear: the polygons have few sides.
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (exact::orient2d(polygon[i].data(), polygon[(i + 1) % polygon.size()].data(), point.data()) <= 0)
      return false;
  return true;
}

}  // namespace lrb::construct
