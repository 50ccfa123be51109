/// Builds the intersection of two surfaces as a graph.
///
/// 1. Number the corners of all pairs' intersections; corners with the same features are one point.
/// 2. Collect the curves (segments) and the outlines of coplanar areas.
/// 3. Label connected components by union-find.

#include "engine/query/contact/contact_graph.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>

namespace lrb {
namespace {

/// A feature of a surface, named by its vertices (see Places) so that all simplices around it agree: a vertex
/// (v, v), an edge (v < w), or the interior of a simplex (kNull, s).
using SurfaceFeature = std::pair<std::uint32_t, std::uint32_t>;

/// Merges vertices with equal coordinates, as along seams of textures: returns the first one requested.
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
  std::map<std::pair<SurfaceFeature, SurfaceFeature>, std::uint32_t> number;
  Places of_a(context.body[0].rep()), of_b(context.body[1].rep());
  for (std::uint32_t i = 0; i < result.pairs.size(); ++i) {
    const PairContactRecord& contact = result.contacts[i];
    ContactGraph::Piece piece{i, {}};
    for (int c = 0; c < contact.corner_count; ++c) {
      const exact::ContactCorner& corner = contact.corners[static_cast<std::size_t>(c)];
      // Named by features of both surfaces: the pairs on both sides of an edge agree without comparing
      // coordinates.
      const auto key = std::pair{surface_feature(of_a, result.pairs[i].a, corner.on_a),
                                 surface_feature(of_b, result.pairs[i].b, corner.on_b)};
      const auto [it, is_new] = number.try_emplace(key, static_cast<std::uint32_t>(graph.points.size()));
      if (is_new) graph.points.push_back(corner.x);
      piece.points.push_back(it->second);
    }
    graph.pieces.push_back(std::move(piece));
  }
}

void find_curves_and_outlines(ContactGraph& graph) {
  std::map<Edge, std::uint32_t> polygon_sides;
  // Count the polygons at each side.
  for (const auto& piece : graph.pieces)
    for (std::size_t c = 0; piece.points.size() >= 3 && c < piece.points.size(); ++c)
      ++polygon_sides[ordered(piece.points[c], piece.points[(c + 1) % piece.points.size()])];
  for (const auto& [edge, count] : polygon_sides)
    // A side between two polygons is inside the contact area.
    if (count % 2 != 0) graph.outlines.push_back(edge);
  // Segments: those on the side of a polygon belong to its outline, and those of no length are points.
  for (const auto& piece : graph.pieces) {
    if (piece.points.size() != 2) continue;
    const Edge e = ordered(piece.points[0], piece.points[1]);
    if (e[0] != e[1] && !polygon_sides.contains(e)) graph.curves.push_back(e);
  }
  // A segment along an edge comes from each pair at that edge: keep one.
  std::sort(graph.curves.begin(), graph.curves.end());
  graph.curves.erase(std::unique(graph.curves.begin(), graph.curves.end()), graph.curves.end());
}

void label_components(ContactGraph& graph) {
  std::vector<std::uint32_t> leader(graph.points.size());
  // Union-find with path halving. The smallest index is the leader, so that labels are in order of points.
  std::iota(leader.begin(), leader.end(), 0u);
  const auto find = [&](std::uint32_t p) {
    while (leader[p] != p) p = leader[p] = leader[leader[p]];
    return p;
  };
  for (const auto& piece : graph.pieces)
    for (const std::uint32_t p : piece.points) {
      const std::uint32_t x = find(piece.points[0]), y = find(p);
      leader[std::max(x, y)] = std::min(x, y);
    }
  graph.component.assign(graph.points.size(), kNull);
  for (std::uint32_t p = 0; p < graph.points.size(); ++p) {
    const std::uint32_t root = find(p);  // root <= p, so it has its label already, unless it is p
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

}  // namespace lrb
