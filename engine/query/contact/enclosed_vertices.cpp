#include "engine/query/contact/enclosed_vertices.hpp"

#include "engine/query/walk/relation.hpp"

namespace lrb {

EnclosedVertices::EnclosedVertices(QueryContext& context, Side side, const CollideResult& result)
    : body_(context[side]), holder_(context[other(side)]), side_(side), result_(result) {
  for (std::uint32_t i = 0; i < result.pairs.size(); ++i) {
    VertexId v[3];
    body_.rep().simplex(simplex(i), v);
    near_.insert(v, v + body_.rep().simplex_size());
  }
}

SimplexId EnclosedVertices::simplex(std::uint32_t pair) const {
  return side_ == Side::a ? result_.pairs[pair].a : result_.pairs[pair].b;
}

bool EnclosedVertices::is_inside(VertexId v) {
  // Only edges of simplices in contact can cross the other surface, so that only their corners need to be
  // located. All other vertices that are reached from inside are inside.
  return !near_.contains(v) || locate(holder_, body_.world(v)) == Where::inside;
}

std::vector<VertexId> EnclosedVertices::from(std::span<const std::uint32_t> pairs) {
  std::vector<VertexId> inside;
  if (!holder_.rep().closed()) return inside;
  std::unordered_set<VertexId> seen;
  const auto visit = [&](VertexId v) {
    if (seen.insert(v).second && is_inside(v)) inside.push_back(v);
  };
  for (const std::uint32_t i : pairs) {
    // Seeds: the enclosed corners of the simplices in these pairs.
    VertexId v[3];
    body_.rep().simplex(simplex(i), v);
    for (int k = 0; k < body_.rep().simplex_size(); ++k) visit(v[k]);
  }
  // Breadth-first search over surface edges; each vertex is visited once.
  const SurfaceGraph& graph = body_.surface_graph();
  for (std::size_t next = 0; next < inside.size(); ++next)
    for (const VertexId v : graph.neighbours(inside[next])) visit(v);
  return inside;
}

}  // namespace lrb
