#include "engine/lrb/surface_graph.hpp"

#include <algorithm>

namespace lrb {

SurfaceGraph::SurfaceGraph(const LrbRep& rep) {
  const std::size_t vertices = rep.vertices().size();
  const auto for_each_edge = [&](const auto& visit) {
    for (FaceId f = 0; f < rep.real_face_count(); ++f) {
      const auto corners = rep.face(f);
      for (std::size_t i = 0; i < corners.size(); ++i) visit(corners[i], corners[(i + 1) % corners.size()]);
    }
  };
  // Counting sort by the first vertex; edges occur in both directions, and once for each of their faces.
  std::vector<std::uint32_t> ends(vertices + 1, 0);
  for_each_edge([&](VertexId v, VertexId w) { ++ends[v + 1], ++ends[w + 1]; });
  for (std::size_t v = 0; v < vertices; ++v) ends[v + 1] += ends[v];
  neighbours_.resize(ends[vertices]);
  offsets_ = ends;
  for_each_edge([&](VertexId v, VertexId w) {
    neighbours_[offsets_[v]++] = w;
    neighbours_[offsets_[w]++] = v;
  });
  // Sort the neighbours of each vertex, and keep each once.
  auto kept = neighbours_.begin();
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto begin = neighbours_.begin() + ends[v], end = neighbours_.begin() + ends[v + 1];
    std::sort(begin, end);
    offsets_[v] = static_cast<std::uint32_t>(kept - neighbours_.begin());
    kept = std::unique_copy(begin, end, kept);
  }
  offsets_[vertices] = static_cast<std::uint32_t>(kept - neighbours_.begin());
  neighbours_.erase(kept, neighbours_.end());
  neighbours_.shrink_to_fit();
}

}  // namespace lrb
