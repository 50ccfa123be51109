#include "engine/query/contact/contact_graph.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace lrb {
namespace {

/// A feature of a surface, named by its vertices so that all simplices around it agree: a vertex (v, v), an
/// edge (v < w), or the interior of a simplex (kNull, s).
using SurfaceFeature = std::pair<std::uint32_t, std::uint32_t>;

SurfaceFeature surface_feature(const LrbRep& rep, SimplexId s, exact::Feature f) {
  VertexId v[3];
  rep.simplex(s, v);
  const int n = rep.simplex_size();
  if (f.dim == 0) return {v[f.index], v[f.index]};
  if (f.dim == 1 && n == 3) return std::minmax({v[f.index], v[(f.index + 1) % 3]});
  return {kNull, s};
}

using Edge = std::array<std::uint32_t, 2>;

Edge ordered(std::uint32_t p, std::uint32_t q) {
  return {std::min(p, q), std::max(p, q)};
}

void number_corners(const QueryContext& context, const CollideResult& result, ContactGraph& graph) {
  std::map<std::pair<SurfaceFeature, SurfaceFeature>, std::uint32_t> number;
  for (std::uint32_t i = 0; i < result.pairs.size(); ++i) {
    const PairContactRecord& contact = result.contacts[i];
    ContactGraph::Piece piece{i, {}};
    for (int c = 0; c < contact.corner_count; ++c) {
      const exact::ContactCorner& corner = contact.corners[static_cast<std::size_t>(c)];
      const auto key = std::pair{surface_feature(context.body[0].rep(), result.pairs[i].a, corner.on_a),
                                 surface_feature(context.body[1].rep(), result.pairs[i].b, corner.on_b)};
      const auto [it, is_new] = number.try_emplace(key, static_cast<std::uint32_t>(graph.points.size()));
      if (is_new) graph.points.push_back(corner.x);
      piece.points.push_back(it->second);
    }
    graph.pieces.push_back(std::move(piece));
  }
}

void find_curves_and_outlines(ContactGraph& graph) {
  std::map<Edge, std::uint32_t> polygon_sides;
  for (const auto& piece : graph.pieces)
    for (std::size_t c = 0; piece.points.size() >= 3 && c < piece.points.size(); ++c)
      ++polygon_sides[ordered(piece.points[c], piece.points[(c + 1) % piece.points.size()])];
  for (const auto& [edge, count] : polygon_sides)
    if (count % 2 != 0) graph.outlines.push_back(edge);
  for (const auto& piece : graph.pieces) {
    if (piece.points.size() != 2) continue;
    const Edge e = ordered(piece.points[0], piece.points[1]);
    if (e[0] != e[1] && !polygon_sides.contains(e)) graph.curves.push_back(e);
  }
  std::sort(graph.curves.begin(), graph.curves.end());
  graph.curves.erase(std::unique(graph.curves.begin(), graph.curves.end()), graph.curves.end());
}

void label_components(ContactGraph& graph) {
  std::vector<std::uint32_t> leader(graph.points.size());
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
