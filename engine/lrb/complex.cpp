// Closedness of a set of oriented faces: its boundary, a sum of oriented edges, is zero (the boundary
// operator of homology). Edges are numbered once:
// 1. Take the edge that starts at each corner, as a pair of vertices with a direction.
// 2. Sort the corners by edge: a counting sort by the first vertex, a sort by the second within each vertex.
// 3. Number the runs of equal pairs.
// Then each face adds its directions to the sums of its edges, and only the edges touched are tested.

#include "engine/lrb/complex.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

#include "engine/core/numbering.hpp"
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb {

BoundarySum::BoundarySum(const LrbRep& rep) : rep_(rep) {
  const LrbData& d = rep.data();
  const std::size_t corners = d.face_vertices.size();
  edge_of_corner_.resize(corners);
  direction_.resize(corners);
  // The ends of the edge that starts at each corner. In 2D an "edge" is a vertex at which a segment starts or
  // ends.
  std::vector<std::pair<VertexId, VertexId>> ends(corners);
  for (FaceId f = 0; f < rep.face_count(); ++f) {
    const auto face = rep.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const std::size_t c = d.face_offsets[f] + i;
      // An edge between a vertex and itself (v == w) has direction 0 and cancels.
      const VertexId v = face[i], w = face[(i + 1) % face.size()];
      ends[c] = rep.dim() == 2 ? std::pair{v, v} : std::pair{std::min(v, w), std::max(v, w)};
      direction_[c] = rep.dim() == 2 ? (i == 0 ? 1 : -1) : v == w ? 0 : v < w ? 1 : -1;
    }
  }
  // Sort the corners by the first end of their edge (counting sort), then those of one vertex by the second
  // end.
  std::vector<std::uint32_t> offsets(rep.vertices().size() + 1, 0), order(corners);
  for (const auto& end : ends) ++offsets[end.first];
  std::exclusive_scan(offsets.begin(), offsets.end(), offsets.begin(), 0u);
  for (std::uint32_t c = 0; c < corners; ++c) order[offsets[ends[c].first]++] = c;
  // The counting sort has moved each offset to the end of its vertex's range, which is the start of the next.
  for (std::size_t v = 0, begin = 0; v + 1 < offsets.size(); begin = offsets[v++])
    std::sort(order.begin() + begin, order.begin() + offsets[v],
              [&](auto x, auto y) { return std::pair(ends[x].second, x) < std::pair(ends[y].second, y); });
  // Equal pairs are adjacent now: number the runs. One corner per edge is stored, to identify the edge in
  // messages.
  for (std::size_t k = 0; k < corners; ++k) {
    if (k == 0 || ends[order[k]] != ends[order[k - 1]]) corner_of_edge_.push_back(order[k]);
    edge_of_corner_[order[k]] = static_cast<std::uint32_t>(corner_of_edge_.size() - 1);
  }
  sum_.assign(corner_of_edge_.size(), 0);
}

void BoundarySum::change(FaceId f, int sign) {
  const auto& offsets = rep_.data().face_offsets;
  for (std::uint32_t c = offsets[f]; c < offsets[f + 1]; ++c) {
    sum_[edge_of_corner_[c]] += sign * direction_[c];
    touched_.push_back(edge_of_corner_[c]);
  }
}

bool BoundarySum::take_closed(VertexId open_at[2]) {
  // Edges not touched have sum 0. Every touched sum is reset, even after the first open edge is found.
  bool closed = true;
  for (const std::uint32_t e : touched_) {
    if (sum_[e] != 0 && closed) {
      closed = false;
      const auto& d = rep_.data();
      // Identify the edge: find the face of its corner by binary search in the offsets.
      const std::uint32_t c = corner_of_edge_[e];
      const auto f = static_cast<FaceId>(std::upper_bound(d.face_offsets.begin(), d.face_offsets.end(), c) -
                                         d.face_offsets.begin() - 1);
      const auto face = rep_.face(f);
      const std::size_t i = c - d.face_offsets[f];
      open_at[0] = face[i];
      open_at[1] = rep_.dim() == 2 ? face[i] : face[(i + 1) % face.size()];
    }
    sum_[e] = 0;
  }
  touched_.clear();
  return closed;
}

std::vector<VertexId> piece_vertices(const LrbRep& rep, std::span<const FaceId> faces) {
  // Union-find over vertices: the corners of one face are in one component.
  DisjointSets pieces(rep.vertices().size());
  for (const FaceId f : faces)
    for (const VertexId v : rep.face(f).subspan(1)) pieces.join(rep.face(f)[0], v);
  // The leader of a set is a vertex of its component. Each is listed at its first face.
  std::vector<VertexId> out;
  std::vector<bool> seen(rep.vertices().size(), false);
  for (const FaceId f : faces) {
    const VertexId v(pieces.leader(rep.face(f)[0]));
    if (!seen[v]) out.push_back(v);
    seen[v] = true;
  }
  return out;
}

namespace {

struct Border {
  std::uint64_t key;  ///< its vertices, the smaller one first
  SimplexId simplex;
  std::uint32_t which;
  bool operator<(const Border& other) const {
    return key != other.key ? key < other.key : simplex < other.simplex;
  }
};

}  // namespace

std::vector<Across> real_neighbours(const LrbRep& rep) {
  const auto corners = static_cast<std::uint32_t>(rep.simplex_size());
  std::vector<Border> borders;
  borders.reserve(std::size_t{corners} * rep.real_simplex_count());
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    for (std::uint32_t e = 0; e < corners; ++e) {
      // Key of the border: both vertices, regardless of direction. In 2D a border is one vertex, taken twice.
      const VertexId from = v[e], to = corners == 3 ? v[(e + 1) % 3] : v[e];
      const std::uint64_t low = std::min(from, to).value(), high = std::max(from, to).value();
      borders.push_back({low << 32 | high, s, e});
    }
  }
  // Simplices at the same border become adjacent in the list.
  std::sort(borders.begin(), borders.end());
  std::vector<Across> out(rep.real_simplex_count(), Across{kNull, kNull, kNull});
  for (std::size_t begin = 0, end = 0; begin < borders.size(); begin = end) {
    while (end < borders.size() && borders[end].key == borders[begin].key) ++end;
    // Link each group in a cycle. On a manifold surface a group is a pair, and the two simplices are linked
    // to each other.
    for (std::size_t i = begin; i < end && end - begin > 1; ++i) {
      const Border& next = borders[i + 1 < end ? i + 1 : begin];
      out[borders[i].simplex][borders[i].which] = next.simplex;
    }
  }
  return out;
}

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
