#include "engine/query/walk/surface_graph.hpp"

#include <algorithm>

namespace lrb {

SurfaceGraph::SurfaceGraph(const LrbRep& rep) {
  // All edges of real faces, in both directions; shared ones occur once for each face.
  std::vector<std::pair<VertexId, VertexId>> edges;
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    const auto corners = rep.face(f);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const VertexId v = corners[i], w = corners[(i + 1) % corners.size()];
      edges.emplace_back(v, w);
      edges.emplace_back(w, v);
    }
  }
  // Sorted by the first vertex: the neighbours of a vertex are then contiguous.
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  // Compressed rows: count the neighbours of each vertex, then add up the counts.
  offsets_.assign(rep.vertices().size() + 1, 0);
  for (const auto& [v, w] : edges) {
    ++offsets_[v + 1];
    neighbours_.push_back(w);
  }
  for (std::size_t v = 0; v + 1 < offsets_.size(); ++v) offsets_[v + 1] += offsets_[v];
}

}  // namespace lrb
