/// Contact manifolds; contact_manifold.hpp lists the steps.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>

#include <Eigen/Geometry>

#include "engine/collide/interiors.hpp"
#include "engine/collide/relation.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/distance/manifold_points.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

using Eigen::Vector3d;

/// Returns a unit vector, or zero for a vector without a direction.
Vector3d direction_of(const Vector3d& v) {
  const Vector3d unit = v.stableNormalized();
  return unit.allFinite() && unit.norm() > 0.5 ? unit : Vector3d::Zero();
}

/// A direction along which two triangles touch.
struct PairAxis {
  Vector3d normal = Vector3d::Zero();
  double depth = 0;
  /// 0: no axis. 1: the touching features are extreme on their surfaces. 2: they are also on top of each
  /// other, and both faces are across the axis.
  int rank = 0;
};

/// Makes the manifolds of one pair of bodies. Works relative to `origin_`, in `unit_`.
class ManifoldMaker {
 public:
  ManifoldMaker(QueryContext& query, ManifoldContext& context, const ManifoldRequest& request,
                const ManifoldResult* previous, ManifoldResult& result)
      : query_(query),
        context_(context),
        result_(result),
        dim_(query.body[0].rep().dim()),
        margin_(request.margin) {
    for (int side = 0; side < 2; ++side) {
      const LrbRep& rep = body(side).rep();
      context.stars[side].begin(rep);
      is_closed_[side] = rep.closed();
      is_mirrored_[side] = is_reflection(body(side).world.pose(), dim_);
      size_[side] = context.stars[side].diagonal() * stretch(body(side).world.pose());
    }
    smaller_ = std::min(size_[0], size_[1]);
    if (previous != nullptr)
      for (const ContactManifold& manifold : previous->manifolds)
        for (const ManifoldPoint& point : manifold.points) chosen_before_.insert({point.on[0], point.on[1]});
    // Pairs that intersect, as collide() lists them, for the search for enclosed vertices.
    for (std::uint32_t i = 0; i < result.pairs.size(); ++i)
      if (result.pairs[i].meet != exact::Meet::disjoint) {
        meeting_.push_back(i);
        collision_.pairs.push_back({result.pairs[i].a, result.pairs[i].b});
      }
  }

  void run() {
    const std::vector<Region> regions = merged(connected());
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
      enter(regions[r].pairs);
      region_meets_ = std::any_of(regions[r].pairs.begin(), regions[r].pairs.end(),
                                  [&](std::uint32_t i) { return meets(i); });
      const std::vector<std::vector<std::uint32_t>> groups = divided(regions[r].pairs);
      for (std::size_t g = 0; g < groups.size(); ++g)
        add_manifold(r, groups[g], normals_[g], regions[r].enclosed);
    }
  }

 private:
  QueryBody& body(int side) { return query_.body[side]; }
  const NearPair& pair(std::uint32_t i) const { return result_.pairs[i]; }
  SimplexId simplex_of(std::uint32_t i, int side) const { return side == 0 ? pair(i).a : pair(i).b; }
  bool meets(std::uint32_t i) const { return pair(i).meet != exact::Meet::disjoint; }

  // Regions.

  struct Region {
    std::vector<std::uint32_t> pairs;                ///< ascending
    std::array<std::vector<SimplexId>, 2> enclosed;  ///< simplices around vertices inside the other body

    void add(const Region& other) {
      pairs.insert(pairs.end(), other.pairs.begin(), other.pairs.end());
      for (std::size_t side = 0; side < 2; ++side)
        enclosed[side].insert(enclosed[side].end(), other.enclosed[side].begin(), other.enclosed[side].end());
    }
  };

  /// Returns the connected groups of pairs, each ascending, by their first pairs.
  std::vector<std::vector<std::uint32_t>> connected() {
    const auto count = static_cast<std::uint32_t>(result_.pairs.size());
    DisjointSets sets(count);
    // Pairs with the same vertex of A and the same vertex of B are connected.
    std::unordered_map<std::uint64_t, std::uint32_t> first_at;
    first_at.reserve(std::size_t{4} * count);
    for (std::uint32_t i = 0; i < count; ++i) {
      VertexId v[2][3];
      for (int side = 0; side < 2; ++side) places(side, simplex_of(i, side), v[side]);
      for (int k = 0; k < dim_; ++k)
        for (int m = 0; m < dim_; ++m) {
          const std::uint64_t key = std::uint64_t{v[0][k]} << 32 | v[1][m];
          const auto [at, is_new] = first_at.try_emplace(key, i);
          if (!is_new) sets.join(i, at->second);
        }
    }
    std::vector<std::vector<std::uint32_t>> regions;
    std::vector<std::uint32_t> region(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t root = sets.leader(i);  // root <= i: its region is set already unless it is i
      if (root == i) {
        region[i] = static_cast<std::uint32_t>(regions.size());
        regions.emplace_back();
      }
      region[i] = region[root];
      regions[region[i]].push_back(i);
    }
    return regions;
  }

  /// Merges groups of pairs that enclose a common part of a surface, and adds the enclosed parts.
  std::vector<Region> merged(const std::vector<std::vector<std::uint32_t>>& connected) {
    // Unite each group with the first one that encloses the same simplex.
    DisjointSets sets(connected.size());
    std::vector<Region> groups;
    std::unordered_map<SimplexId, std::uint32_t> first_around[2];
    for (std::uint32_t g = 0; g < connected.size(); ++g) {
      groups.push_back({connected[g], enclosed_by(connected[g])});
      for (int side = 0; side < 2; ++side)
        for (const SimplexId s : groups[g].enclosed[side])
          if (const auto [at, is_new] = first_around[side].try_emplace(s, g); !is_new)
            sets.join(g, at->second);
    }
    // The first group of each set becomes the region.
    std::vector<Region> regions;
    std::vector<std::size_t> region_of(groups.size());
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
      const std::uint32_t leader = sets.leader(g);
      if (leader == g) {
        region_of[g] = regions.size();
        regions.push_back(std::move(groups[g]));
      } else {
        regions[region_of[leader]].add(groups[g]);
      }
    }
    for (Region& region : regions) std::sort(region.pairs.begin(), region.pairs.end());
    return regions;
  }

  void places(int side, SimplexId s, VertexId out[3]) {
    body(side).rep().simplex(s, out);
    for (int k = 0; k < dim_; ++k) out[k] = context_.stars[side].at(out[k]);
  }

  /// Moves the origin to a region, and sets the unit to a power of two near its size.
  void enter(const std::vector<std::uint32_t>& region) {
    const double* c[3];
    body(0).world.corners(pair(region[0]).a, c);
    origin_ = Eigen::Map<const Vector3d>(c[0]);
    for (auto& known : simplices_) known.clear();
    if (dim_ == 2) origin_.z() = 0;
    double most = 0;
    for (const std::uint32_t i : region)
      for (int side = 0; side < 2; ++side) {
        body(side).world.corners(simplex_of(i, side), c);
        for (int k = 0; k < dim_; ++k)
          most = std::max(most, (Eigen::Map<const Vector3d>(c[k]) / 2 - origin_ / 2).cwiseAbs().maxCoeff());
      }
    unit_ = most > 0 ? std::ldexp(1.0, std::clamp(std::ilogb(most) + 1, -1000, 1000)) : 1;
  }

  Vector3d local(const double* x) const {
    Vector3d out = (Eigen::Map<const Vector3d>(x) / 2 - origin_ / 2) / (unit_ / 2);
    if (dim_ == 2) out.z() = 0;
    return out;
  }
  Vector3d world(const Vector3d& x) const { return origin_ + unit_ * x; }

  /// Returns a simplex relative to the current region. The reference is valid until enter().
  const PatchSimplex& simplex(int side, SimplexId s) {
    const auto [at, is_new] = simplices_[side].try_emplace(s);
    if (is_new) at->second = patch_simplex(side, s);
    return at->second;
  }

  PatchSimplex patch_simplex(int side, SimplexId s) {
    PatchSimplex out;
    out.id = s;
    out.two_sided = !is_closed_[side];
    const double* c[3];
    body(side).world.corners(s, c);
    for (int k = 0; k < dim_; ++k) out.x[k] = local(c[k]);
    places(side, s, out.place);
    const Vector3d along = direction_of(out.x[1] - out.x[0]);
    // In 2D the solid is on the left of a segment.
    const Vector3d n = dim_ == 2 ? Vector3d(along.y(), -along.x(), 0)
                                 : Vector3d(along.cross(direction_of(out.x[2] - out.x[0])));
    out.normal = direction_of(is_mirrored_[side] ? Vector3d(-n) : n);
    return out;
  }

  // Normals.

  /// Returns true if the part of a simplex that is farthest along a direction is extreme on its surface: no
  /// corner of the simplices around it is farther. This part is a vertex, an edge or the entire simplex.
  /// Writes the corners of the part to `part`, and their number to `count`.
  bool is_farthest_extreme(int side, const PatchSimplex& s, const Vector3d& direction, int part[3],
                           int& count) {
    double farthest = -std::numeric_limits<double>::infinity(), extent = 0;
    for (int k = 0; k < dim_; ++k) {
      farthest = std::max(farthest, direction.dot(s.x[k]));
      extent = std::max(extent, (s.x[k] - s.x[0]).cwiseAbs().maxCoeff());
    }
    count = 0;
    for (int k = 0; k < dim_; ++k)
      if (direction.dot(s.x[k]) >= farthest - kAxisAdvantage * extent) part[count++] = k;
    return count == dim_ || is_feature_extreme(side, s, direction, part, count);
  }

  /// The same for a given vertex (count 1) or edge (count 2) of a triangle, or a vertex of a segment.
  bool is_feature_extreme(int side, const PatchSimplex& s, const Vector3d& direction, const int* part,
                          int count) {
    const Vector3d& x = s.x[part[0]];
    for (const SimplexId t : context_.stars[side].around(s.place[part[0]])) {
      const PatchSimplex& around = simplex(side, t);
      if (count == 2 && std::find(around.place, around.place + dim_, s.place[part[1]]) == around.place + dim_)
        continue;
      for (int k = 0; k < dim_; ++k) {
        const Vector3d to = around.x[k] - x;
        if (direction.dot(to) > kExtremeSlope * to.norm()) return false;
      }
    }
    return true;
  }

  /// Tests the normals of both triangles, the products of their edges, and the segment between their closest
  /// points.
  PairAxis axis_of(std::uint32_t i) {
    const PatchSimplex &a = simplex(0, pair(i).a), &b = simplex(1, pair(i).b);
    double extent = 0;
    for (int k = 0; k < dim_; ++k)
      for (int m = 0; m < dim_; ++m) extent = std::max(extent, (a.x[k] - b.x[m]).cwiseAbs().maxCoeff());
    // The axis of least depth of each rank. The first of several that are nearly equal counts: faces first.
    PairAxis best[3];
    const auto consider = [&](PairAxis axis) {
      // A face along the axis is beside the contact: that of a wall on the ground, or the end of a gear.
      if (axis.rank == 2 &&
          std::min(std::abs(a.normal.dot(axis.normal)), std::abs(b.normal.dot(axis.normal))) < kSteepestEdge)
        axis.rank = 1;
      PairAxis& other = best[axis.rank];
      if (other.rank == 0 || axis.depth < other.depth - kAxisAdvantage * extent) other = axis;
    };
    for (int side = 0; side < 2; ++side)
      for (const double sign : {1.0, -1.0}) {
        // Both sides of a surface that is not closed, else the outer one. The normal points from A to B.
        if (sign < 0 && is_closed_[side]) continue;
        const Vector3d& n = side == 0 ? a.normal : b.normal;
        consider(face_axis(a, b, side, sign * (side == 0 ? 1 : -1) * n));
      }
    if (dim_ == 3)
      for (int k = 0; k < 3; ++k)
        for (int m = 0; m < 3; ++m) consider(edge_axis(a, k, b, m));
    if (!meets(i)) consider(closest_axis(a, b, i));
    // Features that are on top of each other may be on opposite sides of a body.
    const bool is_far = best[1].rank > 0 && best[1].depth > 0 && kFarAxis * best[1].depth < best[2].depth;
    return best[2].rank > 0 && !is_far ? best[2] : best[1];
  }

  /// Returns true if a direction from A to B enters neither body at its face.
  bool leaves(const PatchSimplex& a, const PatchSimplex& b, const Vector3d& n, double least) const {
    return (!is_closed_[0] || a.normal.dot(n) >= least) && (!is_closed_[1] || b.normal.dot(n) <= -least);
  }

  /// The axis along the normal of the face of one side: the other's nearest part must be extreme.
  PairAxis face_axis(const PatchSimplex& a, const PatchSimplex& b, int side, const Vector3d& n) {
    if (n.isZero() || !leaves(a, b, n, -kOverlayRounding)) return {};
    const PatchSimplex &face = side == 0 ? a : b, &other = side == 0 ? b : a;
    const Vector3d outward = side == 0 ? n : Vector3d(-n);
    int part[3] = {}, count = 0;
    if (!is_farthest_extreme(1 - side, other, -outward, part, count)) return {};
    PairAxis out{n, -outward.dot(other.x[part[0]] - face.x[0]), 1};
    for (int k = 0; k < count; ++k)
      if (is_over(face, other.x[part[k]])) out.rank = 2;
    return out;
  }

  /// Returns true if a point projected along a face's normal is on it.
  bool is_over(const PatchSimplex& face, const Vector3d& x) const {
    if (dim_ == 2) {
      const Vector3d along = face.x[1] - face.x[0];
      const double t = along.dot(x - face.x[0]) / along.squaredNorm();
      return t >= -kOverlayRounding && t <= 1 + kOverlayRounding;
    }
    const double area = (face.x[1] - face.x[0]).cross(face.x[2] - face.x[0]).norm();
    const double sign = (face.x[1] - face.x[0]).cross(face.x[2] - face.x[0]).dot(face.normal) < 0 ? -1 : 1;
    for (int k = 0; k < 3; ++k) {
      const Vector3d edge = face.x[(k + 1) % 3] - face.x[k];
      if (!(sign * edge.cross(x - face.x[k]).dot(face.normal) >= -kOverlayRounding * area)) return false;
    }
    return true;
  }

  /// The axis perpendicular to an edge of each: both must be extreme, and cross as seen along the axis.
  PairAxis edge_axis(const PatchSimplex& a, int k, const PatchSimplex& b, int m) {
    const int of_a[2] = {k, (k + 1) % 3}, of_b[2] = {m, (m + 1) % 3};
    const Vector3d &p = a.x[k], &q = b.x[m];
    const Vector3d e = a.x[of_a[1]] - p, f = b.x[of_b[1]] - q;
    Vector3d n = e.cross(f);
    const double turn_sq = n.squaredNorm();
    if (!(turn_sq > kParallelEdges * kParallelEdges * e.squaredNorm() * f.squaredNorm())) return {};
    // Parameters of the closest points of both lines.
    const double t = (q - p).cross(f).dot(n) / turn_sq, u = (q - p).cross(e).dot(n) / turn_sq;
    if (!(t >= 0 && t <= 1 && u >= 0 && u <= 1)) return {};
    n = direction_of(n);
    if (n.dot(a.normal - b.normal) < 0) n = -n;
    if (!leaves(a, b, n, kSteepestEdge) || !is_feature_extreme(0, a, n, of_a, 2) ||
        !is_feature_extreme(1, b, -n, of_b, 2))
      return {};
    return {n, n.dot(p - q), 2};
  }

  /// The axis along the segment between the closest points of a disjoint pair.
  PairAxis closest_axis(const PatchSimplex& a, const PatchSimplex& b, std::uint32_t i) {
    const Vector3d along = local(pair(i).point[1].data()) - local(pair(i).point[0].data());
    const Vector3d n = direction_of(along);
    int part[3], count = 0;
    if (n.isZero() || !leaves(a, b, n, -kOverlayRounding) || !is_farthest_extreme(0, a, n, part, count) ||
        !is_farthest_extreme(1, b, -n, part, count))
      return {};
    return {n, -along.norm(), 2};
  }

  /// The normal of a pair without an axis: the mean of both faces' normals.
  Vector3d mean_normal(std::uint32_t i) {
    const Vector3d n = simplex(0, pair(i).a).normal - simplex(1, pair(i).b).normal;
    return n.norm() > kContactNormalLeast ? direction_of(n) : Vector3d::Zero();
  }

  // Manifolds.

  /// Divides a region into groups of pairs with similar normals, and writes the normal of each to normals_.
  std::vector<std::vector<std::uint32_t>> divided(const std::vector<std::uint32_t>& region) {
    std::vector<PairAxis> axes;
    int rank = 0;
    for (const std::uint32_t i : region) {
      axes.push_back(axis_of(i));
      rank = std::max(rank, axes.back().rank);
    }
    normals_.clear();
    if (rank == 0) {
      Vector3d sum = Vector3d::Zero();
      for (const std::uint32_t i : region) sum += mean_normal(i);
      normals_.push_back(direction_of(sum));
      return {region};
    }
    // Pairs with the best rank found: the deepest first. Depths at which features are not on top of each
    // other are too large by any amount: the least first.
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < region.size(); ++k)
      if (axes[k].rank == rank) order.push_back(k);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
      return rank == 2 ? axes[x].depth > axes[y].depth : axes[x].depth < axes[y].depth;
    });
    // Axes much deeper than the least one are axes across an overlap: the faces on either side of a corner
    // that is inside the other body.
    double far = std::numeric_limits<double>::infinity();
    for (const std::size_t k : order)
      if (rank == 1 && axes[k].depth > 0) far = std::min(far, kFarAxis * axes[k].depth);
    std::vector<std::size_t> group(region.size(), region.size());
    for (const std::size_t k : order) {
      if (group[k] < region.size() || axes[k].depth > far) continue;
      for (const std::size_t other : order)
        if (group[other] == region.size() && axes[other].normal.dot(axes[k].normal) >= kManifoldAngle)
          group[other] = normals_.size();
      group[k] = normals_.size();
      normals_.push_back(axes[k].normal);
    }
    // The other pairs join the group with the closest normal.
    std::vector<std::vector<std::uint32_t>> groups(normals_.size());
    for (std::size_t k = 0; k < region.size(); ++k) {
      if (group[k] == region.size()) {
        const Vector3d n = axes[k].rank > 0 ? axes[k].normal : mean_normal(region[k]);
        group[k] = 0;
        for (std::size_t g = 1; g < normals_.size(); ++g)
          if (normals_[g].dot(n) > normals_[group[k]].dot(n)) group[k] = g;
      }
      groups[group[k]].push_back(region[k]);
    }
    return groups;
  }

  /// Returns the simplices of each body around its vertices that the region encloses in the other.
  std::array<std::vector<SimplexId>, 2> enclosed_by(const std::vector<std::uint32_t>& region) {
    std::array<std::vector<SimplexId>, 2> out;
    std::vector<std::uint32_t> pairs;
    for (const std::uint32_t i : region)
      if (meets(i))
        pairs.push_back(static_cast<std::uint32_t>(std::lower_bound(meeting_.begin(), meeting_.end(), i) -
                                                   meeting_.begin()));
    if (pairs.empty()) return out;
    if (collision_.contacts.empty())
      for (const SimplexPair& p : collision_.pairs) collision_.contacts.push_back(contact_of(query_, p));
    for (int side = 0; side < 2; ++side) {
      if (!is_closed_[1 - side]) continue;
      if (!enclosed_[side]) enclosed_[side].emplace(query_, static_cast<Side>(side), collision_);
      for (const VertexId v : enclosed_[side]->from(pairs)) {
        const auto around = context_.stars[side].around(context_.stars[side].at(v));
        out[side].insert(out[side].end(), around.begin(), around.end());
      }
    }
    return out;
  }

  void add_manifold(std::uint32_t region, const std::vector<std::uint32_t>& pairs, const Vector3d& normal,
                    const std::array<std::vector<SimplexId>, 2>& enclosed) {
    ContactManifold out;
    out.normal = normal + Vector3d::Zero();  // -0 becomes 0
    out.pairs = pairs;
    out.region = region;
    for (const std::uint32_t i : pairs) out.intersects = out.intersects || meets(i);
    std::vector<ManifoldCandidate> chosen;
    if (!normal.isZero()) chosen = reduced_overlay(pairs, normal, enclosed);
    for (const ManifoldCandidate& c : chosen) {
      ManifoldPoint point;
      for (int side = 0; side < 2; ++side) {
        // A vertex has its world coordinates, bit for bit.
        point.point[side] =
            c.on[side].kind == FeatureKind::vertex
                ? Vector3d(Eigen::Map<const Vector3d>(body(side).world(VertexId(c.on[side].first))))
                : world(c.x[side]);
        if (dim_ == 2) point.point[side].z() = 0;
        point.on[side] = c.on[side];
      }
      // Where no pair intersects, a depth above 0 is rounding.
      point.depth = (region_meets_ ? c.depth : std::min(c.depth, 0.0)) * unit_ + 0.0;
      // Pairs that intersect may be in another manifold of the region.
      out.intersects = out.intersects || point.depth > 0;
      out.points.push_back(point);
    }
    if (out.points.empty()) add_closest(out);
    result_.manifolds.push_back(std::move(out));
  }

  std::vector<ManifoldCandidate> reduced_overlay(const std::vector<std::uint32_t>& pairs,
                                                 const Vector3d& normal,
                                                 const std::array<std::vector<SimplexId>, 2>& enclosed) {
    std::vector<PatchSimplex> patch[2];
    for (int side = 0; side < 2; ++side) {
      std::vector<SimplexId> simplices = enclosed[side];
      for (const std::uint32_t i : pairs) simplices.push_back(simplex_of(i, side));
      std::sort(simplices.begin(), simplices.end());
      simplices.erase(std::unique(simplices.begin(), simplices.end()), simplices.end());
      for (const SimplexId s : simplices) patch[side].push_back(simplex(side, s));
    }
    const double size = smaller_ / unit_;
    std::vector<ManifoldCandidate> candidates =
        overlay_corners(patch[0], patch[1], dim_, normal, -margin_ / unit_ - kDepthRounding * size);
    for (ManifoldCandidate& c : candidates) c.was_chosen = chosen_before_.contains({c.on[0], c.on[1]});
    return reduce_candidates(std::move(candidates), dim_, normal, size, [&](const ManifoldCandidate& c) {
      return c.depth <= kDepthRounding * size || (region_meets_ && is_overlap(c));
    });
  }

  /// Returns true if the points of a candidate are the ends of a segment in one of the bodies. Otherwise they
  /// are on parts of the surfaces that only seem to overlap, such as opposite sides of a ring.
  bool is_overlap(const ManifoldCandidate& c) {
    constexpr int kSamples = 16;
    if (!is_closed_[0] && !is_closed_[1]) return true;
    for (int side = 0; side < 2; ++side) {
      bool is_inside = is_closed_[side];
      // From B's point through A, or from A's through B.
      const Vector3d step = (c.x[side] - c.x[1 - side]) / kSamples;
      for (int k = 0; k < kSamples && is_inside; ++k) {
        const Vector3d x = world(c.x[1 - side] + k * step);
        is_inside = locate(body(side), x.data()) != Where::outside;
      }
      if (is_inside) return true;
    }
    return false;
  }

  /// Adds the closest points of the nearest pair to a manifold whose patches do not overlap.
  void add_closest(ContactManifold& manifold) {
    const std::uint32_t nearest = *std::min_element(
        manifold.pairs.begin(), manifold.pairs.end(), [&](std::uint32_t x, std::uint32_t y) {
          return std::tie(pair(x).lower, x) < std::tie(pair(y).lower, y);
        });
    ManifoldPoint point;
    for (int side = 0; side < 2; ++side) {
      point.point[side] = pair(nearest).point[side];
      const std::uint32_t s = simplex_of(nearest, side);
      point.on[side] = {FeatureKind::triangle, s, s};
    }
    if (!meets(nearest)) {
      const Vector3d along = local(point.point[1].data()) - local(point.point[0].data());
      if (const Vector3d n = direction_of(along); !n.isZero()) manifold.normal = n;
      point.depth = -along.norm() * unit_;
    }
    manifold.points.push_back(point);
  }

  QueryContext& query_;
  ManifoldContext& context_;
  ManifoldResult& result_;
  int dim_;
  double margin_;
  bool is_closed_[2], is_mirrored_[2];
  bool region_meets_ = false;  ///< a pair of the current region intersects
  double size_[2], smaller_ = 0;
  Vector3d origin_{0, 0, 0};
  double unit_ = 1;
  std::unordered_map<SimplexId, PatchSimplex> simplices_[2];  ///< used in the current region
  std::vector<Vector3d> normals_;                             ///< of the groups of the current region
  std::vector<std::uint32_t> meeting_;                        ///< pairs that intersect, ascending
  CollideResult collision_;                                   ///< these pairs, and their contacts once needed
  std::optional<EnclosedVertices> enclosed_[2];
  std::set<std::array<SurfaceFeatureId, 2>> chosen_before_;
};

}  // namespace

void check_request(const ManifoldRequest& request) {
  if (!(request.margin >= 0) || std::isinf(request.margin))
    throw InputError("contact manifolds: expected a finite margin of at least 0, found " +
                     std::to_string(request.margin));
}

void contact_manifolds_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                            const ManifoldRequest& request, const ManifoldResult* previous, Workers& workers,
                            QueryContext& query, NearPairsContext& near, ManifoldContext& context,
                            ManifoldResult& result) {
  const FloatMode float_mode;
  check_request(request);
  NearPairsRequest pairs;
  pairs.within = request.margin;
  pairs.max_pairs = request.max_pairs > 0 ? request.max_pairs : kMaxPairsWithContacts;
  near_pairs_into(a, pose_a, b, pose_b, pairs, workers, near, context.near);
  result.pairs = context.near.pairs;
  result.manifolds.clear();
  result.pose[0] = pose_a;
  result.pose[1] = pose_b;
  double reach = 0;
  if (!result.pairs.empty()) {
    query.body[0].world.begin(a, pose_a);
    query.body[1].world.begin(b, pose_b);
    for (QueryBody& body : query.body) body.query_body();
    ManifoldMaker(query, context, request, previous, result).run();
    reach = kContactMoves * std::min(context.stars[0].diagonal() * stretch(pose_a),
                                     context.stars[1].diagonal() * stretch(pose_b));
  }
  number_points(result, previous, reach);
}

ManifoldResult contact_manifolds(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                 const ManifoldRequest& request, const ManifoldResult* previous,
                                 unsigned threads) {
  Workers workers(threads);
  QueryContext query;
  NearPairsContext near;
  ManifoldContext context;
  ManifoldResult result;
  contact_manifolds_into(a, pose_a, b, pose_b, request, previous, workers, query, near, context, result);
  return result;
}

}  // namespace lrb
