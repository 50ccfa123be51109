// Describes a contact: the intersection of each pair, and its connected regions with loops, length, area,
// centroid, normal and a depth estimate.
//
// 1. Compute the intersection of each pair exactly.
// 2. Build the graph of the pieces. Number the corners of all intersections: corners with the same features
//    are one point. Collect the curves (segments) and the outlines of coplanar areas. Label connected
//    components by union-find.
// 3. Average centroid and normal of each component over its pieces of the highest dimension.
// 4. Chain the edges of each component into loops.
// 5. Estimate the depth along the normal from the enclosed vertices of both bodies.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include <Eigen/Geometry>

#include "engine/collide/interiors.hpp"
#include "engine/collide/relation.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/lrb/complex.hpp"

namespace lrb {
namespace {

using Edge = ContactGraph::Edge;

/// Names features of a surface by their vertices, so that all simplices around them agree.
class FeatureNames {
 public:
  explicit FeatureNames(const LrbRep& rep) : rep_(rep), graph_(rep.surface_graph()) {}

  /// Returns the name of a feature of a simplex: a vertex (v, v), an edge (v < w), or an interior (kNull, s).
  std::uint64_t name(SimplexId s, exact::Feature f) const {
    const int n = rep_.simplex_size();
    // In 2D the simplex is the segment itself: its dimension 1 is the interior.
    if (f.dim >= n - 1) return packed(kNull, s);
    VertexId v[3];
    rep_.simplex(s, v);
    const VertexId p = graph_.place(v[f.index]);
    if (f.dim == 0) return packed(p, p);
    const VertexId q = graph_.place(v[(f.index + 1) % 3]);
    return p < q ? packed(p, q) : packed(q, p);
  }

 private:
  static std::uint64_t packed(std::uint32_t p, std::uint32_t q) { return std::uint64_t{p} << 32 | q; }

  const LrbRep& rep_;
  const SurfaceGraph& graph_;
};

Edge ordered(std::uint32_t p, std::uint32_t q, std::uint32_t piece) {
  return {std::min(p, q), std::max(p, q), piece};
}

/// Orders edges by their points; of those with equal points, sets and sort() with unique() keep the first.
struct ByPoints {
  static auto points(const Edge& e) { return std::pair(e[0], e[1]); }
  bool operator()(const Edge& d, const Edge& e) const { return points(d) < points(e); }
};

void number_corners(QueryContext& context, const CollideResult& result) {
  ContactGraph& graph = context.contact.graph;
  Numbering<2>& numbering = context.contact.corners;
  const FeatureNames on_a(context[Side::a].rep()), on_b(context[Side::b].rep());
  graph.points.clear();
  graph.pieces.clear();
  numbering.begin(result.pairs.size());
  for (std::uint32_t i = 0; i < result.pairs.size(); ++i) {
    const PairContactRecord& contact = result.contacts[i];
    ContactGraph::Piece piece{i, contact.corner_count, {}};
    for (std::size_t c = 0; c < contact.corner_count; ++c) {
      const exact::ContactCorner& corner = contact.corners[c];
      // Identified by features of both surfaces, so the pairs on both sides of an edge agree without
      // comparing coordinates.
      const auto [number, is_new] = numbering.number(
          {on_a.name(result.pairs[i].a, corner.on_a), on_b.name(result.pairs[i].b, corner.on_b)});
      if (is_new) graph.points.push_back(corner.x);
      piece.corners[c] = number;
    }
    graph.pieces.push_back(piece);
  }
}

void find_curves_and_outlines(ContactGraph& graph) {
  graph.outlines.clear();
  graph.curves.clear();
  std::map<Edge, std::uint32_t, ByPoints> polygon_sides;
  // Count the polygons at each side.
  for (std::uint32_t i = 0; i < graph.pieces.size(); ++i) {
    const auto& piece = graph.pieces[i];
    for (std::size_t c = 0; piece.count >= 3 && c < piece.count; ++c)
      ++polygon_sides[ordered(piece.corners[c], piece.corners[(c + 1) % piece.count], i)];
  }
  for (const auto& [edge, count] : polygon_sides)
    // A side of two polygons is interior to the contact area.
    if (count % 2 != 0) graph.outlines.push_back(edge);
  // Segments that are a side of a polygon belong to its outline, and segments of length 0 are points.
  for (std::uint32_t i = 0; i < graph.pieces.size(); ++i) {
    const auto& piece = graph.pieces[i];
    if (piece.count != 2) continue;
    const Edge e = ordered(piece.corners[0], piece.corners[1], i);
    if (e[0] != e[1] && (polygon_sides.empty() || !polygon_sides.contains(e))) graph.curves.push_back(e);
  }
  // A segment along an edge occurs in each pair at that edge: keep one.
  std::sort(graph.curves.begin(), graph.curves.end());
  const auto same = [](const Edge& d, const Edge& e) { return ByPoints::points(d) == ByPoints::points(e); };
  graph.curves.erase(std::unique(graph.curves.begin(), graph.curves.end(), same), graph.curves.end());
}

void label_components(ContactGraph& graph, DisjointSets& sets) {
  sets.reset(graph.points.size());
  for (const auto& piece : graph.pieces)
    for (const std::uint32_t p : piece.points()) sets.join(piece.corners[0], p);
  graph.component.resize(graph.points.size());
  graph.component_count = 0;
  for (std::uint32_t p = 0; p < graph.points.size(); ++p) {
    const std::uint32_t root = sets.leader(p);  // root <= p: its label is set already unless it is p
    graph.component[p] = root == p ? graph.component_count++ : graph.component[root];
  }
}

/// Builds the graph from result.pairs and result.contacts, in the context's buffers.
ContactGraph& built_graph(QueryContext& context, const CollideResult& result) {
  number_corners(context, result);
  find_curves_and_outlines(context.contact.graph);
  label_components(context.contact.graph, context.contact.sets);
  return context.contact.graph;
}

/// Chains the outlines and curves of each component into loops: closed ones if all of their points have two
/// edges, otherwise open chains between ends or branch points. Uses every edge once.
class Chainer {
 public:
  Chainer(ContactBuffers& buffers, const CollideResult& result)
      : b_(buffers), graph_(buffers.graph), result_(result) {
    b_.edges.assign(graph_.outlines.begin(), graph_.outlines.end());
    b_.edges.insert(b_.edges.end(), graph_.curves.begin(), graph_.curves.end());
    b_.is_used.assign(b_.edges.size(), 0);
    // Counting sort of the ends of edges by point.
    std::vector<std::uint32_t>& first = b_.first_end;
    first.assign(graph_.points.size() + 2, 0);
    for (const Edge& e : b_.edges) ++first[e[0] + 2], ++first[e[1] + 2];
    for (std::size_t p = 2; p < first.size(); ++p) first[p] += first[p - 1];
    b_.ends.resize(2 * b_.edges.size());
    for (std::uint32_t e = 0; e < b_.edges.size(); ++e)
      for (const std::size_t end : {0, 1}) b_.ends[first[b_.edges[e][end] + 1]++] = e;
  }

  void add_loops(std::vector<ContactRegion>& regions) {
    // Follow open chains first, from their ends. The remaining ones are closed.
    for (std::uint32_t p = 0; p < graph_.points.size(); ++p) {
      const std::span<const std::uint32_t> at = ends_at(p);
      for (const std::uint32_t edge : at)
        if (at.size() != 2 && b_.is_used[edge] == 0) walk(p, edge, regions);
    }
    for (std::uint32_t e = 0; e < b_.edges.size(); ++e)
      if (b_.is_used[e] == 0) walk(b_.edges[e][0], e, regions);
  }

 private:
  std::span<const std::uint32_t> ends_at(std::uint32_t point) const {
    return {b_.ends.data() + b_.first_end[point], b_.first_end[point + 1] - b_.first_end[point]};
  }

  void walk(std::uint32_t from, std::uint32_t edge, std::vector<ContactRegion>& regions) {
    b_.chain.assign(1, from);
    b_.chained.clear();
    bool closed = false;
    std::uint32_t p = from;
    while (true) {
      b_.is_used[edge] = 1;
      b_.chained.push_back(half_edge(p, graph_.pieces[b_.edges[edge][2]]));
      // Go to the other end of the edge.
      p = b_.edges[edge][0] == p ? b_.edges[edge][1] : b_.edges[edge][0];
      const std::span<const std::uint32_t> at = ends_at(p);
      closed = p == from;
      if (closed) break;
      b_.chain.push_back(p);
      // An end or a branch point: the chain is open.
      if (at.size() != 2) break;
      // Two edges at this point: leave by the unused one.
      edge = b_.is_used[at[0]] != 0 ? at[1] : at[0];
    }
    ContactLoop& loop = regions[graph_.component[from]].loops.emplace_back();
    loop.closed = closed;
    loop.points.reserve(b_.chain.size());
    for (const std::uint32_t q : b_.chain) loop.points.push_back(graph_.points[q]);
    loop.half_edges = b_.chained;
  }

  ContactHalfEdge half_edge(std::uint32_t from, const ContactGraph::Piece& piece) const {
    const auto c = static_cast<std::size_t>(std::find(piece.corners.begin(), piece.corners.end(), from) -
                                            piece.corners.begin());
    const exact::ContactCorner& start = result_.contacts[piece.pair].corners[c];
    return {piece.pair, start.on_a, start.on_b};
  }

  ContactBuffers& b_;
  const ContactGraph& graph_;
  const CollideResult& result_;
};

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
  double most = 0;
  for (int k = 0; k < dim; ++k) {
    x[static_cast<std::size_t>(k)] = Vector3d(c[k][0], c[k][1], c[k][2]);
    most = std::max(most, x[static_cast<std::size_t>(k)].cwiseAbs().maxCoeff());
  }
  // Scaled to about 1 if necessary: products of coordinates then neither overflow nor underflow.
  constexpr double kLarge = 0x1p300, kSmall = 0x1p-300;
  if (most > kLarge || most < kSmall) {
    const double unit = unit_for({x.data(), static_cast<std::size_t>(dim)});
    for (Vector3d& corner : x) corner /= unit;
  }
  // In 2D the solid is on the left of a segment's direction, so the outside is on its right.
  const Vector3d along = x[1] - x[0];
  const Vector3d n = dim == 2 ? Vector3d(along.y(), -along.x(), 0) : along.cross(x[2] - x[0]).eval();
  // A reflection reverses the orientation of every triangle.
  return mirrored ? Vector3d(-n.stableNormalized()) : n.stableNormalized();
}

double polygon_area(std::span<const Vector3d> x) {
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

Weight weigh(std::span<const Vector3d> x) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : x) mean += p / static_cast<double>(x.size());
  // A segment is weighted by its length, a point by 1.
  if (x.size() < 3) return {x.size() == 2 ? (x[1] - x[0]).norm() : 1.0, mean};
  // A polygon: the area-weighted centroid of its fan.
  Vector3d centre = Vector3d::Zero();
  double area = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const Vector3d triangle[3] = {x[0], x[i], x[i + 1]};
    const double a = polygon_area(triangle);
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

/// The outward unit normals of a body's simplices in the world. Remembers those of some simplices, because a
/// simplex is in several pairs.
class WorldNormals {
 public:
  explicit WorldNormals(QueryBody& body)
      : body_(body), is_mirrored_(is_reflection(body.world.pose(), body.rep().dim())) {
    known_.fill(SimplexId(kNull));
  }

  const Vector3d& operator()(SimplexId s) {
    const std::size_t slot = s % kSlots;
    if (known_[slot] != s) {
      known_[slot] = s;
      normal_[slot] = world_normal(body_, s, is_mirrored_);
    }
    return normal_[slot];
  }

 private:
  static constexpr std::size_t kSlots = 128;
  QueryBody& body_;
  bool is_mirrored_;
  std::array<SimplexId, kSlots> known_;
  std::array<Vector3d, kSlots> normal_;
};

/// Builds the regions from the graph. Computes in `unit_` and rescales the results at the end.
class RegionMaker {
 public:
  RegionMaker(QueryContext& ctx, const CollideResult& result)
      : ctx_(ctx),
        result_(result),
        graph_(built_graph(ctx, result)),
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
    std::vector<std::uint32_t>& counts = ctx_.contact.counts;
    counts.assign(regions.size(), 0);
    for (const auto& piece : graph_.pieces)
      if (piece.count > 0) ++counts[graph_.component[piece.corners[0]]];
    for (std::size_t r = 0; r < regions.size(); ++r) regions[r].pairs.reserve(counts[r]);
    for (const auto& piece : graph_.pieces)
      if (piece.count > 0) {
        const std::uint32_t r = graph_.component[piece.corners[0]];
        regions[r].pairs.push_back(piece.pair);
        rank[r] = std::max(rank[r], static_cast<std::uint8_t>(std::min(piece.count, 3U)));
      }
    for (std::uint32_t r = 0; r < regions.size(); ++r) average(regions[r], rank[r]);
    Chainer(ctx_.contact, result_).add_loops(regions);
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
      for (const ContactLoop& loop : regions[r].loops) regions[r].length += loop_length(loop);
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

  /// Sets centroid, normal and coplanar area from the region's pieces of the highest dimension.
  void average(ContactRegion& region, std::uint8_t rank) {
    double total = 0;
    Vector3d centre = Vector3d::Zero(), normal = Vector3d::Zero();
    for (const std::uint32_t i : region.pairs) {
      const auto& piece = graph_.pieces[i];
      if (std::min(piece.count, 3U) != rank) continue;
      std::array<Vector3d, 6> points;
      for (std::uint32_t k = 0; k < piece.count; ++k) points[k] = graph_.points[piece.corners[k]];
      const Weight w = weigh({points.data(), piece.count});
      total += w.value;
      centre += w.value * w.centre;
      // Outward normals are roughly opposite in a contact: their difference points from A to B.
      normal += w.value * (normal_a_(result_.pairs[i].a) - normal_b_(result_.pairs[i].b));
    }
    region.centroid =
        total > 0 ? Vector3d(centre / total) : graph_.points[graph_.pieces[region.pairs[0]].corners[0]];
    // Normals that cancel (surfaces that intersect with the same orientation) leave no meaningful direction.
    if (normal.norm() > kContactNormalLeast * total) region.normal = normal.stableNormalized();
    if (rank == 3) region.area = total;
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
  ContactGraph& graph_;
  EnclosedVertices a_in_b_, b_in_a_;
  double unit_;
  WorldNormals normal_a_{ctx_[Side::a]}, normal_b_{ctx_[Side::b]};
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
  result.contacts.reserve(result.pairs.size());
  for (const SimplexPair& pair : result.pairs) result.contacts.push_back(contact_of(context, pair));
  result.regions = RegionMaker(context, result).run();
}

}  // namespace lrb
