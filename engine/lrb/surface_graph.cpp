#include "engine/lrb/surface_graph.hpp"

#include <algorithm>
#include <bit>

#include "engine/core/numbering.hpp"

namespace lrb {
namespace {

/// Returns the first vertex with the coordinates of each vertex, or an empty list if all are different.
std::vector<VertexId> places_of(std::span<const Eigen::Vector3d> vertices) {
  std::vector<VertexId> places, first;  // `first`: of each place
  Numbering<3> numbering;
  numbering.begin(vertices.size());
  for (VertexId v = 0; v < vertices.size(); ++v) {
    const Eigen::Vector3d x = vertices[v] + Eigen::Vector3d::Zero();  // -0 becomes 0
    const auto bits = [&](int k) { return std::bit_cast<std::uint64_t>(x[k]); };
    const auto [place, is_new] = numbering.number({bits(0), bits(1), bits(2)});
    if (is_new) first.push_back(v);
    places.push_back(first[place]);
  }
  if (first.size() == vertices.size()) places.clear();
  places.shrink_to_fit();
  return places;
}

}  // namespace

SurfaceGraph::SurfaceGraph(const LrbRep& rep) : places_(places_of(rep.vertices())) {
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
