// Boundary loops, with a half-edge structure built for the purpose:
// 1. Sort the sides (half-edges) of all faces by edge. Edges with one side are open; two opposite sides are
//    twins.
// 2. Successor of an open side: rotate around its end through twins to the next open side.
// 3. Follow successors. Whenever a vertex repeats, the part since its first visit is cut off as a loop.
// 4. Measure each loop: length, box, exact planarity.
#include <algorithm>
#include <cstdint>

#include "engine/core/geometry.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include <lrbscope/mesh_repair.hpp>

namespace lrb {
namespace {

/// A side of a face is identified by the corner at which it starts, an index into Mesh::face_vertices.
class LoopFinder {
 public:
  LoopFinder(const Mesh& mesh, const std::vector<FaceUse>& use)
      : mesh_(mesh), next_(mesh.face_vertices.size(), kNull), twin_(mesh.face_vertices.size(), kNull) {
    for (FaceId f = 0; f < mesh.face_count(); ++f)
      if (use[f] != FaceUse::nothing) add_sides(f);
    std::sort(sides_.begin(), sides_.end());
    for (std::size_t i = 0, end = 0; i < sides_.size(); i = end) {
      while (end < sides_.size() && sides_[end].edge == sides_[i].edge) ++end;
      // A run of equal keys: all sides of one edge.
      pair_sides(i, end);
    }
    std::sort(open_.begin(), open_.end());
  }

  std::vector<BoundaryLoop> run() {
    // Link the open sides to chains.
    std::vector<bool> has_predecessor(next_.size(), false);
    successor_.assign(next_.size(), kNull);
    for (const std::uint32_t side : open_) {
      successor_[side] = next_open(side);
      if (successor_[side] != kNull) has_predecessor[successor_[side]] = true;
    }
    seen_.assign(next_.size(), false);
    place_.assign(mesh_.vertices.size(), kNull);
    // Open chains first, from their start. The open sides not visited by then form cycles.
    for (const std::uint32_t side : open_)
      if (!has_predecessor[side]) follow(side);
    for (const std::uint32_t side : open_)
      if (!seen_[side]) follow(side);
    for (BoundaryLoop& loop : loops_) measure(loop);
    // Longest first. The stable sort keeps ties in the order of discovery.
    std::stable_sort(loops_.begin(), loops_.end(),
                     [](const auto& a, const auto& b) { return a.length > b.length; });
    return std::move(loops_);
  }

 private:
  struct SideOfEdge {
    std::uint64_t edge;  ///< smaller vertex, larger vertex
    std::uint32_t side;
    auto operator<=>(const SideOfEdge&) const = default;
  };

  VertexId start(std::uint32_t side) const { return mesh_.face_vertices[side]; }

  FaceId face_of(std::uint32_t side) const {
    const auto& offsets = mesh_.face_offsets;
    const auto behind = std::upper_bound(offsets.begin(), offsets.end(), side);
    return FaceId(static_cast<std::uint32_t>(behind - offsets.begin() - 1));
  }

  void add_sides(FaceId f) {
    const auto corners = mesh_.face(f);
    const std::uint32_t first = mesh_.face_offsets[f];
    // Faces with fewer than three distinct corners cover no area; their sides cancel and are ignored.
    std::vector<VertexId> different(corners.begin(), corners.end());
    std::sort(different.begin(), different.end());
    if (std::unique(different.begin(), different.end()) - different.begin() < 3) return;
    const auto n = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      const VertexId a = corners[i];
      std::uint32_t k = (i + 1) % n;
      if (a == corners[k]) continue;  // a corner listed twice in a row: no side
      sides_.push_back({std::uint64_t{std::min(a, corners[k])} << 32 | std::max(a, corners[k]), first + i});
      // Skip repetitions of the end corner: the next side starts at the last of them.
      while (corners[k] == corners[(k + 1) % n]) k = (k + 1) % n;
      next_[first + i] = first + k;
    }
  }

  void pair_sides(std::size_t i, std::size_t end) {
    const std::uint32_t s = sides_[i].side, t = sides_[end - 1].side;
    if (end - i == 1) open_.push_back(s);
    // Twins are exactly two sides in opposite directions. Non-manifold and flipped edges have no twins.
    if (end - i != 2 || start(s) == start(t)) return;
    twin_[s] = t;
    twin_[t] = s;
  }

  bool is_open(std::uint32_t side) const { return std::binary_search(open_.begin(), open_.end(), side); }

  /// Rotates around the end of an open side, through the adjacent faces, to the next open side. Returns kNull
  /// if the faces do not lead to one.
  std::uint32_t next_open(std::uint32_t from) const {
    // The maps next_ and twin_ are injective and `from` has no twin, so the rotation cannot cycle.
    std::uint32_t side = next_[from];
    while (!is_open(side)) {
      if (twin_[side] == kNull) return kNull;
      side = next_[twin_[side]];
    }
    return side;
  }

  /// Follows a boundary to its end or back to its start, and cuts off a loop whenever a vertex repeats.
  void follow(std::uint32_t first) {
    std::vector<VertexId> row = {start(first)};
    place_[row[0]] = 0;
    std::uint32_t last = first;
    for (std::uint32_t side = first; side != kNull && !seen_[side]; side = successor_[side]) {
      seen_[side] = true;
      last = side;
      const VertexId end = start(next_[side]);
      // A new vertex extends the chain.
      if (place_[end] == kNull) {
        place_[end] = static_cast<std::uint32_t>(row.size());
        row.push_back(end);
        continue;
      }
      // A vertex of the chain repeats: the part since its first visit is a loop. The rest continues from that
      // vertex.
      BoundaryLoop& loop = loops_.emplace_back();
      loop.is_loop = true;
      loop.face = face_of(side);
      loop.vertices.assign(row.begin() + place_[end], row.end());
      for (std::size_t i = place_[end] + std::size_t{1}; i < row.size(); ++i) place_[row[i]] = kNull;
      row.resize(place_[end] + std::size_t{1}, VertexId(0));
    }
    // Reset only the entries used. If everything was cut off as loops, one vertex remains.
    for (const VertexId v : row) place_[v] = kNull;
    if (row.size() < 2) return;
    BoundaryLoop& rest = loops_.emplace_back();
    rest.vertices = std::move(row);
    rest.face = face_of(last);
  }

  void measure(BoundaryLoop& loop) const {
    const auto& x = mesh_.vertices;
    for (std::size_t i = 0; i < loop.edges(); ++i)
      loop.length += norm3(x[loop.vertices[(i + 1) % loop.vertices.size()]] - x[loop.vertices[i]]);
    // Exact predicates need finite coordinates; without them planarity stays false.
    bool finite = true;
    for (const VertexId v : loop.vertices) {
      loop.box.extend(x[v]);
      finite &= x[v].allFinite();
    }
    if (!finite) return;
    const auto plane = spanning_corners(mesh_, loop.vertices);
    loop.planar = !plane || is_planar(mesh_, loop.vertices, *plane);
  }

  const Mesh& mesh_;
  std::vector<SideOfEdge> sides_;
  std::vector<std::uint32_t> next_;  ///< (corners) the next side of its face; kNull: no side
  /// (corners) the opposite side of a manifold edge, in the other face; kNull: none
  std::vector<std::uint32_t> twin_;
  std::vector<std::uint32_t> open_, successor_;
  std::vector<bool> seen_;
  std::vector<std::uint32_t> place_;  ///< (|V|) index in the chain being followed; kNull: not in it
  std::vector<BoundaryLoop> loops_;
};

}  // namespace

std::vector<BoundaryLoop> find_boundary_loops(const Mesh& mesh, const std::vector<FaceUse>& use) {
  if (mesh.dim == 2) return {};
  return LoopFinder(mesh, use).run();
}

}  // namespace lrb
