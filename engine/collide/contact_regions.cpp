/// Builds the intersection of two surfaces as a graph.
///
/// 1. Number the corners of all pairs' intersections; corners with the same features are one point.
/// 2. Collect the curves (segments) and the outlines of coplanar areas.
/// 3. Label connected components by union-find.

#include "engine/collide/contact_regions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <unordered_map>

#include <Eigen/Geometry>

#include "engine/collide/interiors.hpp"
#include "engine/core/tolerances.hpp"
#include <lrbscope/core/disjoint_sets.hpp>

namespace lrb {
namespace {

/// A feature of a surface, named by its vertices (see Places) so that all simplices around it agree: a vertex
/// (v, v), an edge (v < w), or the interior of a simplex (kNull, s).
using SurfaceFeature = std::pair<std::uint32_t, std::uint32_t>;

/// Merges vertices with equal coordinates, as along texture seams, into the first one requested.
class Places {
 public:
  explicit Places(const LrbRep& rep) : rep_(rep) {}

  VertexId at(VertexId v) {
    const auto [known, is_new] = first_.try_emplace(v, v);
    if (is_new) {
      const Eigen::Vector3d x = rep_.vertices()[v] + Eigen::Vector3d::Zero();  // -0 becomes 0
      known->second = by_place_.try_emplace({x[0], x[1], x[2]}, v).first->second;
    }
    return known->second;
  }
  const LrbRep& rep() const { return rep_; }

 private:
  const LrbRep& rep_;
  std::unordered_map<VertexId, VertexId> first_;
  std::map<std::array<double, 3>, VertexId> by_place_;
};

SurfaceFeature surface_feature(Places& places, SimplexId s, exact::Feature f) {
  VertexId v[3];
  places.rep().simplex(s, v);
  const int n = places.rep().simplex_size();
  for (int k = 0; k < n; ++k) v[k] = places.at(v[k]);
  if (f.dim == 0) return {v[f.index], v[f.index]};
  // In 2D the simplex is the segment itself: its dimension 1 is the interior.
  if (f.dim == 1 && n == 3) return std::minmax({v[f.index], v[(f.index + 1) % 3]});
  return {kNull, s};
}

using Edge = std::array<std::uint32_t, 2>;

Edge ordered(std::uint32_t p, std::uint32_t q) {
  return {std::min(p, q), std::max(p, q)};
}

void number_corners(const QueryContext& context, const CollideResult& result, ContactGraph& graph) {
  const auto hash = [](const std::pair<SurfaceFeature, SurfaceFeature>& key) {
    // Multiplicative hashing of the four numbers.
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;
    const auto packed = [](const SurfaceFeature& f) { return std::uint64_t{f.first} << 32 | f.second; };
    const std::uint64_t h = packed(key.first) * kOdd;
    const std::uint64_t both = ((h ^ h >> 32) + packed(key.second)) * kOdd;
    return static_cast<std::size_t>(both ^ both >> 32);
  };
  std::unordered_map<std::pair<SurfaceFeature, SurfaceFeature>, std::uint32_t, decltype(hash)> number(
      2 * result.pairs.size(), hash);
  Places of_a(context.body[0].rep()), of_b(context.body[1].rep());
  for (std::uint32_t i = 0; i < result.pairs.size(); ++i) {
    const PairContactRecord& contact = result.contacts[i];
    ContactGraph::Piece piece{i, contact.corner_count, {}};
    for (std::size_t c = 0; c < contact.corner_count; ++c) {
      const exact::ContactCorner& corner = contact.corners[c];
      // Identified by features of both surfaces, so the pairs on both sides of an edge agree without
      // comparing coordinates.
      const auto key = std::pair{surface_feature(of_a, result.pairs[i].a, corner.on_a),
                                 surface_feature(of_b, result.pairs[i].b, corner.on_b)};
      const auto [it, is_new] = number.try_emplace(key, static_cast<std::uint32_t>(graph.points.size()));
      if (is_new) graph.points.push_back(corner.x);
      piece.corners[c] = it->second;
    }
    graph.pieces.push_back(piece);
  }
}

void find_curves_and_outlines(ContactGraph& graph) {
  std::map<Edge, std::uint32_t> polygon_sides;
  // Count the polygons at each side.
  for (const auto& piece : graph.pieces)
    for (std::size_t c = 0; piece.count >= 3 && c < piece.count; ++c)
      ++polygon_sides[ordered(piece.corners[c], piece.corners[(c + 1) % piece.count])];
  for (const auto& [edge, count] : polygon_sides)
    // A side of two polygons is interior to the contact area.
    if (count % 2 != 0) graph.outlines.push_back(edge);
  // Segments that are a side of a polygon belong to its outline, and segments of length 0 are points.
  for (const auto& piece : graph.pieces) {
    if (piece.count != 2) continue;
    const Edge e = ordered(piece.corners[0], piece.corners[1]);
    if (e[0] != e[1] && !polygon_sides.contains(e)) graph.curves.push_back(e);
  }
  // A segment along an edge occurs in each pair at that edge: keep one.
  std::sort(graph.curves.begin(), graph.curves.end());
  graph.curves.erase(std::unique(graph.curves.begin(), graph.curves.end()), graph.curves.end());
}

void label_components(ContactGraph& graph) {
  DisjointSets sets(graph.points.size());
  for (const auto& piece : graph.pieces)
    for (const std::uint32_t p : piece.points()) sets.join(piece.corners[0], p);
  graph.component.assign(graph.points.size(), kNull);
  for (std::uint32_t p = 0; p < graph.points.size(); ++p) {
    const std::uint32_t root = sets.leader(p);  // root <= p: its label is set already unless it is p
    graph.component[p] = root == p ? graph.component_count++ : graph.component[root];
  }
}

}  // namespace

ContactGraph contact_graph(const QueryContext& context, const CollideResult& result) {
  ContactGraph graph;
  number_corners(context, result, graph);
  find_curves_and_outlines(graph);
  label_components(graph);
  return graph;
}

namespace {

class Chainer {
 public:
  Chainer(std::span<const std::array<std::uint32_t, 2>> edges, const std::vector<Eigen::Vector3d>& points)
      : edges_(edges), points_(points), used_(edges.size(), false) {
    for (std::uint32_t e = 0; e < edges.size(); ++e)
      for (const std::uint32_t p : edges[e]) ends_.push_back({p, e});
    std::sort(ends_.begin(), ends_.end());
  }

  std::vector<ContactLoop> run() {
    std::vector<ContactLoop> loops;
    // Follow open chains first, from their ends. The remaining ones are closed.
    for (std::size_t i = 0; i < ends_.size();) {
      const std::span<const End> at = ends_at(ends_[i].point);
      for (const End& end : at)
        if (at.size() != 2 && !used_[end.edge]) loops.push_back(walk(end.point, end.edge));
      i += at.size();
    }
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      if (!used_[e]) loops.push_back(walk(edges_[e][0], e));
    return loops;
  }

 private:
  /// An edge at a point.
  struct End {
    std::uint32_t point, edge;
    friend auto operator<=>(const End&, const End&) = default;
  };

  std::span<const End> ends_at(std::uint32_t point) const {
    const auto begin = std::lower_bound(ends_.begin(), ends_.end(), End{point, 0});
    auto end = begin;
    while (end != ends_.end() && end->point == point) ++end;
    return {std::to_address(begin), static_cast<std::size_t>(end - begin)};
  }

  ContactLoop walk(std::uint32_t from, std::uint32_t edge) {
    ContactLoop loop;
    loop.points.push_back(points_[from]);
    std::uint32_t p = from;
    while (true) {
      used_[edge] = true;
      // Go to the other end of the edge.
      p = edges_[edge][0] == p ? edges_[edge][1] : edges_[edge][0];
      const std::span<const End> at = ends_at(p);
      loop.closed = p == from;
      if (loop.closed) break;
      loop.points.push_back(points_[p]);
      // An end or a branch point: the chain is open.
      if (at.size() != 2) break;
      // Two edges at this point: leave by the unused one.
      edge = used_[at[0].edge] ? at[1].edge : at[0].edge;
    }
    return loop;
  }

  std::span<const std::array<std::uint32_t, 2>> edges_;
  const std::vector<Eigen::Vector3d>& points_;
  std::vector<bool> used_;
  std::vector<End> ends_;  ///< ascending
};

}  // namespace

std::vector<ContactLoop> chain_edges(std::span<const std::array<std::uint32_t, 2>> edges,
                                     const std::vector<Eigen::Vector3d>& points) {
  return Chainer(edges, points).run();
}

// Describes a contact: the intersection of each pair, and its connected regions with loops, length, area,
// centroid, normal and a depth estimate.
//
// 1. Compute the intersection of each pair exactly, and build the graph of the pieces (contact_regions.hpp).
// 2. Average centroid and normal of each component over its pieces of the highest dimension.
// 3. Chain the edges of each component into loops.
// 4. Estimate the depth along the normal from the enclosed vertices of both bodies.

namespace {

using Eigen::Vector3d;

/// Returns the power of two by which to divide points so that no product of two or three coordinates
/// overflows or underflows, as the product of an area and a coordinate would for bodies of size 1e-120 or
/// 1e120.
double unit_for(std::span<const Vector3d> points) {
  double most = 0;
  for (const Vector3d& p : points) most = std::max(most, p.cwiseAbs().maxCoeff());
  return most > 0 ? std::ldexp(1.0, std::clamp(std::ilogb(most), -1022, 1023)) : 1;
}

/// Returns the outward unit normal of a real simplex in the world, also for a mirrored body; zero if
/// degenerate.
Vector3d world_normal(QueryBody& body, SimplexId s, bool mirrored) {
  const double* c[3];
  body.world.corners(s, c);
  const int dim = body.rep().dim();
  std::array<Vector3d, 3> x = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  for (int k = 0; k < dim; ++k) x[k] = Vector3d(c[k][0], c[k][1], c[k][2]);
  // Scaled to about 1: products of coordinates then neither overflow nor underflow.
  const double unit = unit_for({x.data(), static_cast<std::size_t>(dim)});
  const auto at = [&](int k) { return Vector3d(x[k] / unit); };
  // In 2D the solid is on the left of a segment's direction, so the outside is on its right.
  const Vector3d along = at(1) - at(0);
  const Vector3d n = dim == 2 ? Vector3d(along.y(), -along.x(), 0) : along.cross(at(2) - at(0)).eval();
  // A reflection reverses the orientation of every triangle.
  return mirrored ? Vector3d(-n.stableNormalized()) : n.stableNormalized();
}

double polygon_area(const std::vector<Vector3d>& x) {
  // Triangle fan: the cross products add up to twice the vector area.
  Vector3d twice = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < x.size(); ++i) twice += (x[i] - x[0]).cross(x[i + 1] - x[0]);
  return 0.5 * twice.norm();
}

/// The weight of a piece in averages over its region: its length, area or count.
struct Weight {
  double value;
  Vector3d centre;
};

Weight weigh(const std::vector<Vector3d>& x) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : x) mean += p / static_cast<double>(x.size());
  // A segment is weighted by its length, a point by 1.
  if (x.size() < 3) return {x.size() == 2 ? (x[1] - x[0]).norm() : 1.0, mean};
  // A polygon: the area-weighted centroid of its fan.
  Vector3d centre = Vector3d::Zero();
  double area = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double a = polygon_area({x[0], x[i], x[i + 1]});
    area += a;
    centre += a * (x[0] + x[i] + x[i + 1]) / 3;
  }
  return {area, area > 0 ? Vector3d(centre / area) : mean};
}

double loop_length(const ContactLoop& loop) {
  double sum = 0;
  const std::size_t n = loop.points.size();
  // A closed loop has one more segment, back to its first point.
  for (std::size_t i = 0; i + 1 < n + (loop.closed ? 1 : 0); ++i)
    sum += (loop.points[(i + 1) % n] - loop.points[i]).norm();
  return sum;
}

/// Builds the regions from the graph. Computes in `unit_` and rescales the results at the end.
class RegionMaker {
 public:
  RegionMaker(QueryContext& ctx, const CollideResult& result)
      : ctx_(ctx),
        result_(result),
        graph_(contact_graph(ctx, result)),
        a_in_b_(ctx, Side::a, result),
        b_in_a_(ctx, Side::b, result),
        unit_(unit_for(graph_.points)) {
    for (Vector3d& p : graph_.points) p /= unit_;
  }

  std::vector<ContactRegion> run() {
    std::vector<ContactRegion> regions(graph_.component_count);
    std::vector<std::uint8_t> rank(graph_.component_count,
                                   0);  // 3: has polygons, 2: segments, 1: points only
    // Assign pairs to regions. Averages use only a region's pieces of the highest dimension.
    for (const auto& piece : graph_.pieces)
      if (piece.count > 0) {
        const std::uint32_t r = graph_.component[piece.corners[0]];
        regions[r].pairs.push_back(piece.pair);
        rank[r] = std::max(rank[r], static_cast<std::uint8_t>(std::min(piece.count, 3U)));
      }
    for (std::uint32_t r = 0; r < regions.size(); ++r) average(regions[r], rank[r]);
    add_loops(regions);
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
      // Regions of curves have the area spanned by their loops; coplanar ones have their area already.
      if (rank[r] == 2) regions[r].area = spanned_area(regions[r]);
      regions[r].depth_estimate = penetration(regions[r]);
    }
    for (ContactRegion& region : regions) leave_unit(region);
    return regions;
  }

 private:
  void leave_unit(ContactRegion& region) const {
    for (ContactLoop& loop : region.loops)
      for (Vector3d& p : loop.points) p *= unit_;
    region.centroid *= unit_;
    region.length *= unit_;
    region.depth_estimate *= unit_;
    // Multiply twice: the square of the unit could overflow or underflow.
    region.area = region.area * unit_ * unit_;
  }

  std::vector<Vector3d> points_of(const ContactGraph::Piece& piece) const {
    std::vector<Vector3d> x;
    for (const std::uint32_t p : piece.points()) x.push_back(graph_.points[p]);
    return x;
  }

  /// Sets centroid, normal and coplanar area from the region's pieces of the highest dimension.
  void average(ContactRegion& region, std::uint8_t rank) {
    double total = 0;
    Vector3d centre = Vector3d::Zero(), normal = Vector3d::Zero();
    for (const std::uint32_t i : region.pairs) {
      const auto& piece = graph_.pieces[i];
      if (std::min(piece.count, 3U) != rank) continue;
      const Weight w = weigh(points_of(piece));
      total += w.value;
      centre += w.value * w.centre;
      // Outward normals are roughly opposite in a contact: their difference points from A to B.
      normal += w.value * (world_normal(ctx_[Side::a], result_.pairs[i].a, mirrored_[0]) -
                           world_normal(ctx_[Side::b], result_.pairs[i].b, mirrored_[1]));
    }
    region.centroid =
        total > 0 ? Vector3d(centre / total) : graph_.points[graph_.pieces[region.pairs[0]].corners[0]];
    // Normals that cancel (surfaces that intersect with the same orientation) leave no meaningful direction.
    if (normal.norm() > kContactNormalLeast * total) region.normal = normal.stableNormalized();
    if (rank == 3) region.area = total;
  }

  void add_loops(std::vector<ContactRegion>& regions) const {
    std::vector<std::vector<std::array<std::uint32_t, 2>>> edges(regions.size());
    // Both ends of an edge are in the same component.
    for (const auto* list : {&graph_.outlines, &graph_.curves})
      for (const auto& e : *list) edges[graph_.component[e[0]]].push_back(e);
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
      regions[r].loops = chain_edges(edges[r], graph_.points);
      for (const ContactLoop& loop : regions[r].loops) regions[r].length += loop_length(loop);
    }
  }

  /// Returns the sum over the closed loops of the length of each one's vector area.
  static double spanned_area(const ContactRegion& region) {
    double sum = 0;
    for (const ContactLoop& loop : region.loops)
      if (loop.closed) sum += polygon_area(loop.points);
    return sum;
  }

  double penetration(const ContactRegion& region) {
    const bool crosses = std::any_of(region.pairs.begin(), region.pairs.end(),
                                     [&](std::uint32_t i) { return result_.meets[i] == exact::Meet::cross; });
    // Surfaces that only touch do not penetrate.
    if (!crosses || region.normal.isZero()) return 0;
    // Extents along the normal: the furthest point of A's part, the nearest of B's. Contact points belong to
    // both.
    double a_reaches = -std::numeric_limits<double>::infinity(), b_reaches = -a_reaches;
    for (const std::uint32_t i : region.pairs)
      for (const std::uint32_t p : graph_.pieces[i].points()) {
        a_reaches = std::max(a_reaches, region.normal.dot(graph_.points[p]));
        b_reaches = std::min(b_reaches, region.normal.dot(graph_.points[p]));
      }
    // The enclosed parts are polyhedra: apart from contact points only vertices can be extreme.
    for (const VertexId v : a_in_b_.from(region.pairs))
      a_reaches = std::max(a_reaches, region.normal.dot(world(Side::a, v)));
    for (const VertexId v : b_in_a_.from(region.pairs))
      b_reaches = std::min(b_reaches, region.normal.dot(world(Side::b, v)));
    return std::max(0.0, a_reaches - b_reaches);
  }

  Vector3d world(Side side, VertexId v) { return Eigen::Map<const Vector3d>(ctx_[side].world(v)) / unit_; }

  QueryContext& ctx_;
  const CollideResult& result_;
  ContactGraph graph_;
  EnclosedVertices a_in_b_, b_in_a_;
  double unit_;
  const bool mirrored_[2] = {is_reflection(ctx_[Side::a].world.pose(), ctx_[Side::a].rep().dim()),
                             is_reflection(ctx_[Side::b].world.pose(), ctx_[Side::b].rep().dim())};
};

}  // namespace

void describe_contact(QueryContext& context, const CollideRequest& request, CollideResult& result) {
  if (result.pairs.empty() || request.mode != Mode::all_pairs) return;
  if (request.interiors_overlap && result.relation == Relation::touching)
    result.interiors_overlap = interiors_overlap(context, result);
  if (request.interiors_overlap && result.relation == Relation::crossing)
    result.interiors_overlap = crossing_interiors_overlap(context, result);
  if (!request.contacts) return;
  // The intersection of each pair, then the connected regions that they form.
  for (const SimplexPair& pair : result.pairs) result.contacts.push_back(contact_of(context, pair));
  result.regions = RegionMaker(context, result).run();
}

}  // namespace lrb
