#include "engine/construct/convex_hull.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "engine/exact/orient_axes.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::construct {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Quickhull: each point that is still outside waits at one facet that it sees; the furthest point that waits
/// at a facet becomes a corner, and those that waited at the facets it replaces look for new ones.
///
/// The order in which corners are added makes no difference, because no four points count as lying in one
/// plane: each point is thought of as moved towards a point inside by an infinitesimal share, every point by
/// infinitely more than those before it. So a point is behind the planes of earlier points that it lies in,
/// just as if points were added in order; and the hull of the moved points is unique.
class Hull {
 public:
  explicit Hull(std::span<const Eigen::Vector3d> points)
      : points_(points), next_(points.size(), kNull), facet_from_(points.size(), kNull) {}

  std::vector<Triangle> run() {
    if (!start()) return {};
    while (!pending_.empty()) {
      const std::uint32_t f = pending_.back();
      pending_.pop_back();
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
    std::uint32_t waiting = kNull;  ///< the first of the points that wait here
    std::uint32_t furthest = kNull;
    double height = -std::numeric_limits<double>::infinity();  ///< height of the furthest
    bool alive = true;
  };
  struct HorizonEdge {
    std::uint32_t a, b;    ///< in the order that they have in the facet that goes
    std::uint32_t beyond;  ///< the facet that stays
  };

  const double* at(std::uint32_t p) const { return points_[p].data(); }

  /// Makes the first facets, those of a tetrahedron with volume.
  bool start() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    std::uint32_t b = 1, c, d;
    while (b < count && points_[b] == points_[0]) ++b;
    for (c = b + 1; c < count && exact::collinear3d(at(0), at(b), at(c));) ++c;
    int side = 0;
    for (d = c + 1; d < count && (side = exact::orient3d(at(0), at(b), at(c), at(d))) == 0;) ++d;
    if (side == 0) return false;
    if (side > 0) std::swap(b, c);
    first_ = {0, b, c, d};
    for (const Triangle& t : {Triangle{0, b, c}, Triangle{0, d, b}, Triangle{b, d, c}, Triangle{c, d, 0}})
      make(t);
    facets_[0].across = {1, 2, 3};
    facets_[1].across = {3, 2, 0};
    facets_[2].across = {1, 3, 0};
    facets_[3].across = {2, 1, 0};
    for (std::uint32_t p = 0; p < count; ++p)
      if (!is_first(p)) wait(p);
    expect_points();
    return true;
  }

  bool is_first(std::uint32_t p) const { return std::find(first_.begin(), first_.end(), p) != first_.end(); }
  /// Returns a point's place in the order. The first four are never compared with each other.
  std::uint32_t rank(std::uint32_t p) const { return is_first(p) ? 0 : p + 1; }

  std::uint32_t make(const Triangle& t) {
    const Facet facet{t, exact::PlaneSide(at(t[0]), at(t[1]), at(t[2]))};
    std::uint32_t f;
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
    const int side = f.plane.side(at(p));
    return side != 0 ? side > 0 : sees_in_plane(p, f.corners);
  }

  /// Returns true if p, which lies in the plane of t, sees t. The one of the four points that moves most
  /// decides. If that is p, it ends up behind the plane. If it is a corner, the plane turns about the
  /// opposite edge, and p is in front if it is on the corner's side of that edge; if p is on the edge's line,
  /// the next point decides.
  bool sees_in_plane(std::uint32_t p, const Triangle& t) const {
    std::array<int, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return rank(t[i]) > rank(t[j]); });
    for (const int k : order) {
      if (rank(t[k]) < rank(p)) return false;
      const int side = side_of_edge(t[(k + 1) % 3], t[(k + 2) % 3], t[k], p);
      if (side != 0) return side > 0;
    }
    return false;
  }

  /// Returns, for four points in one plane, +1 if p is on the same side of the line a, b as c, and -1 if it
  /// is on the other.
  int side_of_edge(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t p) const {
    for (int x = 0; x < 3; ++x) {
      const int y = (x + 1) % 3;
      const int turn = exact::orient_axes(at(a), at(b), at(c), x, y);
      if (turn != 0) return turn * exact::orient_axes(at(a), at(b), at(p), x, y);
    }
    return 0;
  }

  /// Puts p on the list of the first of the new facets that it sees. If it sees none of them it is inside: a
  /// point that sees a facet that goes and one that stays also sees a new one between them.
  void wait(std::uint32_t p) {
    for (const std::uint32_t f : made_) {
      Facet& facet = facets_[f];
      if (!sees(p, facet)) continue;
      next_[p] = facet.waiting;
      facet.waiting = p;
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

  /// Makes p, which sees facet f, a corner.
  void add(std::uint32_t p, std::uint32_t f) {
    find_visible(p, f);
    for (const HorizonEdge& e : horizon_) {
      const std::uint32_t n = make({e.a, e.b, p});
      facets_[n].across[0] = e.beyond;
      Facet& beyond = facets_[e.beyond];
      for (int i = 0; i < 3; ++i)
        if (beyond.corners[i] == e.b) beyond.across[i] = n;
      facet_from_[e.a] = n;
    }
    for (const std::uint32_t n : made_) {
      const std::uint32_t following = facet_from_[facets_[n].corners[1]];
      facets_[n].across[1] = following;
      facets_[following].across[2] = n;
    }
    for (const std::uint32_t v : visible_) {
      for (std::uint32_t q = facets_[v].waiting; q != kNull;) {
        const std::uint32_t following = next_[q];
        if (q != p) wait(q);
        q = following;
      }
      facets_[v].waiting = kNull;
    }
    // Free the slots only now, so that they were not used again meanwhile; the first four facets keep theirs,
    // for the order.
    for (const std::uint32_t v : visible_)
      if (v >= first_.size()) free_.push_back(v);
    expect_points();
  }

  /// Finds the facets that p sees, which are connected, and marks them as gone.
  void find_visible(std::uint32_t p, std::uint32_t f) {
    visible_ = {f};
    horizon_.clear();
    facets_[f].alive = false;
    for (std::size_t i = 0; i < visible_.size(); ++i) {
      const Facet& facet = facets_[visible_[i]];
      for (int k = 0; k < 3; ++k) {
        Facet& other = facets_[facet.across[k]];
        if (!other.alive) continue;
        if (sees(p, other)) {
          other.alive = false;
          visible_.push_back(facet.across[k]);
        } else {
          horizon_.push_back({facet.corners[k], facet.corners[(k + 1) % 3], facet.across[k]});
        }
      }
    }
  }

  /// Returns the triangles in the order in which adding the points one by one makes them: what is left of the
  /// first four facets, then by last corner and, for the same one, by the edge before it.
  std::vector<Triangle> in_order() const {
    std::vector<Triangle> triangles;
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (!facets_[f].alive) continue;
      Triangle t = facets_[f].corners;
      if (f >= first_.size()) {
        const auto last = std::max_element(
            t.begin(), t.end(), [&](std::uint32_t u, std::uint32_t v) { return rank(u) < rank(v); });
        std::rotate(t.begin(), last + 1, t.end());
      }
      triangles.push_back(t);
    }
    const auto of_first = std::count_if(facets_.begin(), facets_.begin() + first_.size(),
                                        [](const Facet& f) { return f.alive; });
    std::sort(triangles.begin() + of_first, triangles.end(), [](const Triangle& t, const Triangle& u) {
      return std::tie(t[2], t[0], t[1]) < std::tie(u[2], u[0], u[1]);
    });
    return triangles;
  }

  std::span<const Eigen::Vector3d> points_;
  std::array<std::uint32_t, 4> first_ = {};  ///< corners of the first four facets
  std::vector<Facet> facets_;                ///< slots; all but the first four are used again
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> pending_;  ///< slots of facets at which points may wait
  std::vector<std::uint32_t> made_;     ///< the facets that the last corner made
  std::vector<std::uint32_t> visible_;
  std::vector<HorizonEdge> horizon_;
  std::vector<std::uint32_t> next_;        ///< (|points|) the next point that waits at the same facet
  std::vector<std::uint32_t> facet_from_;  ///< (|points|) the new facet whose horizon edge starts here
};

}  // namespace

std::vector<Triangle> convex_hull(std::span<const Eigen::Vector3d> points) {
  return points.size() < 4 ? std::vector<Triangle>() : Hull(points).run();
}

Mesh convex_hull_mesh(std::span<const Eigen::Vector3d> points) {
  Mesh mesh;
  std::vector<VertexId> number(points.size(), kNull);
  for (const Triangle& t : convex_hull(points)) {
    VertexId corners[3];
    for (int i = 0; i < 3; ++i) {
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

}  // namespace lrb::construct
