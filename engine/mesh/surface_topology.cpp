// Topology of a polygon mesh by sorting and union-find, in O(n log n):
// 1. Sort all sides of faces by edge (2D: ends of segments by vertex): by counting for the smaller vertex,
// then
//    the few sides of each vertex by the larger one.
// 2. Unite the faces at each edge to components, and the corners of these faces to fans around the edge's
//    vertices.
// 3. Classify each edge: closed manifold edges have two sides in opposite directions.
// 4. Classify each vertex: manifold vertices have one fan.
// 5. If faces are flipped, name those that disagree with the majority of their surface.
// 6. Genus by Euler's formula, if the surface is closed and manifold.
#include <algorithm>
#include <span>
#include <utility>

#include "engine/mesh/vertex_groups.hpp"
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb {
namespace {

/// One side of a face at an edge (2D: one end of a segment at a vertex).
struct SideUse {
  std::uint64_t key = 0;  ///< the edge: smaller vertex, larger vertex (2D: the vertex)
  FaceId face{};
  std::uint32_t corner = 0;  ///< corner at which the side starts, index into Mesh::face_vertices
  bool forward =
      false;  ///< runs from the smaller to the larger vertex (2D: the segment starts at the vertex)
};

bool has_different_corners(std::span<const VertexId> corners, int needed) {
  if (corners.size() == 3 && needed == 3)  // nearly every face is a triangle
    return corners[0] != corners[1] && corners[1] != corners[2] && corners[0] != corners[2];
  int found = 0;
  for (std::size_t i = 0; i < corners.size() && found < needed; ++i)
    found += std::find(corners.begin(), corners.begin() + i, corners[i]) == corners.begin() + i;
  return found >= needed;
}

class Analysis {
 public:
  Analysis(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report)
      : mesh_(mesh),
        report_(report),
        faces_(mesh.face_count()),
        corners_(mesh.face_vertices.size()),
        fans_(mesh.vertices.size(), 0) {
    // Unusable faces keep kNull as their component.
    out_.component_of_face.assign(mesh.face_count(), kNull);
    all_usable_ = true;
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      all_usable_ &= use[f] != FaceUse::nothing;
      if (use[f] == FaceUse::nothing) continue;
      const bool is_added = has_different_corners(mesh.face(f), mesh.dim);
      if (is_added) add_face(f);
      out_.cycle |= is_added || mesh.dim == 2 || has_different_corners(mesh.face(f), 2);  // has sides
    }
    out_.cycle &= all_usable_;
    sort_sides();
  }

  SurfaceTopology run() {
    // Components first, because classifying an edge marks its component.
    for_each_edge([&](std::span<const SideUse> edge) { join(edge); });
    number_components();
    for_each_edge([&](std::span<const SideUse> edge) { judge(edge); });
    std::sort(open_.begin(), open_.end());
    for (const auto& [corner, face] : open_)
      out_.open_edges.push_back(
          {mesh_.face_vertices[corner], mesh_.face_vertices[next_corner(corner, face)], face});
    const bool manifold = judge_fans();
    if (report_[MeshFault::flipped_face].count > 0) find_reversed();
    out_.closed = all_usable_ && out_.components > 0 &&
                  std::find(out_.component_closed.begin(), out_.component_closed.end(), false) ==
                      out_.component_closed.end();
    if (out_.closed && manifold) out_.genus = mesh_.dim == 2 ? 0 : genus();
    return std::move(out_);
  }

 private:
  void add_face(FaceId f) {
    out_.component_of_face[f] = f;  // preliminary: marks a usable face
    ++faces_used_;
    // Each corner starts as a fan of its own. Every union of two fans decrements the count.
    for (const VertexId v : mesh_.face(f)) ++fans_[v];
  }

  /// Calls visit(vertex, side) for each side of the faces added, in their order; vertex: the smaller one.
  template <class Visit>
  void for_each_side(const Visit& visit) const {
    for (FaceId f = 0; f < mesh_.face_count(); ++f) {
      if (out_.component_of_face[f] == kNull) continue;
      const auto corners = mesh_.face(f);
      const std::uint32_t first = mesh_.face_offsets[f];
      for (std::uint32_t i = 0; i < corners.size(); ++i) {
        const VertexId a = corners[i], b = corners[i + 1 < corners.size() ? i + 1 : 0];
        // 2D: the key is the vertex. The segment starts at its first end.
        if (mesh_.dim == 2)
          visit(a, SideUse{a, f, first + i, i == 0});
        else if (a != b)
          visit(std::min(a, b),
                SideUse{std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), f, first + i, a < b});
      }
    }
  }

  void sort_sides() {
    VertexBuckets<SideUse> by_vertex(mesh_.vertices.size(), [&](const auto& visit) { for_each_side(visit); });
    by_vertex.for_each_group([](VertexId, std::span<SideUse> sides) {
      std::sort(sides.begin(), sides.end(), [](const SideUse& a, const SideUse& b) {
        return a.key != b.key ? a.key < b.key : a.corner < b.corner;
      });
    });
    sides_ = std::move(by_vertex.items());
  }

  template <class Visit>
  void for_each_edge(Visit visit) {
    for (std::size_t i = 0, end = 0; i < sides_.size(); i = end) {
      while (end < sides_.size() && sides_[end].key == sides_[i].key) ++end;
      visit(std::span<const SideUse>(sides_).subspan(i, end - i));
    }
  }

  /// Returns the next corner of the same face.
  std::uint32_t next_corner(std::uint32_t corner, FaceId face) const {
    return corner + 1 == mesh_.face_offsets[face + 1] ? mesh_.face_offsets[face] : corner + 1;
  }
  std::uint32_t next_corner(const SideUse& s) const { return next_corner(s.corner, s.face); }

  void join(std::span<const SideUse> edge) {
    ++edges_;
    for (const SideUse& s : edge.subspan(1)) {
      faces_.join(edge[0].face, s.face);
      if (mesh_.dim == 3) join_fans(edge[0], s);
    }
  }

  /// Unites the fans of two faces at an edge, at both of its ends.
  void join_fans(const SideUse& s, const SideUse& t) {
    // The corners of both faces at the smaller and at the larger vertex of the edge.
    const std::uint32_t low_s = s.forward ? s.corner : next_corner(s),
                        high_s = s.forward ? next_corner(s) : s.corner;
    const std::uint32_t low_t = t.forward ? t.corner : next_corner(t),
                        high_t = t.forward ? next_corner(t) : t.corner;
    if (corners_.join(low_s, low_t)) --fans_[mesh_.face_vertices[low_s]];
    if (corners_.join(high_s, high_t)) --fans_[mesh_.face_vertices[high_s]];
  }

  void number_components() {
    for (FaceId f = 0; f < mesh_.face_count(); ++f) {
      auto& number = out_.component_of_face[f];
      if (number == kNull) continue;
      const std::uint32_t leader = faces_.leader(f);  // the smallest face of its set, hence already numbered
      number = leader == f ? out_.components++ : out_.component_of_face[leader];
    }
    out_.component_closed.assign(out_.components, true);
    out_.component_open.assign(out_.components, false);
  }

  void judge(std::span<const SideUse> edge) {
    // The regular case: two sides, consistently oriented.
    const bool opposite = edge.size() == 2 && edge[0].forward != edge[1].forward;
    if (opposite) return;
    out_.component_closed[out_.component_of_face[edge[0].face]] = false;
    const auto ahead = std::count_if(edge.begin(), edge.end(), [](const SideUse& s) { return s.forward; });
    out_.cycle &= 2 * static_cast<std::size_t>(ahead) == edge.size();
    // Two sides in the same direction: one face is flipped.
    if (edge.size() == 2) return note(report_, MeshFault::flipped_face, edge[0].face, edge[1].face);
    if (edge.size() == 1) {
      out_.component_open[out_.component_of_face[edge[0].face]] = true;
      if (mesh_.dim == 3) open_.emplace_back(edge[0].corner, edge[0].face);
    }
    const MeshFault fault = edge.size() == 1 ? MeshFault::open_edge : MeshFault::non_manifold_edge;
    // The key is the edge: the upper and lower 32 bits are its vertices.
    if (mesh_.dim == 2) return note(report_, fault, static_cast<VertexId>(edge[0].key));
    note(report_, fault, static_cast<VertexId>(edge[0].key >> 32), static_cast<VertexId>(edge[0].key));
  }

  /// Each face f has a reverse side F + f. Edges of two faces unite the sides that are consistent. A surface
  /// of which no face is united with its reverse has two orientations: the sets of f and of F + f.
  void find_reversed() {
    const auto n = static_cast<std::uint32_t>(mesh_.face_count());
    DisjointSets sides(2 * std::size_t{n});
    for_each_edge([&](std::span<const SideUse> edge) {
      if (edge.size() != 2) return;
      const std::uint32_t f = edge[0].face, g = edge[1].face;
      const bool flipped = edge[0].forward == edge[1].forward;
      sides.join(f, flipped ? n + g : g);
      sides.join(n + f, flipped ? g : n + g);
    });
    // The smaller set of each surface is the faces to be reversed.
    std::vector<std::uint32_t> size(2 * std::size_t{n}, 0);
    for (std::uint32_t f = 0; f < n; ++f) ++size[sides.leader(f)];
    for (std::uint32_t f = 0; f < n; ++f) {
      const std::uint32_t side = sides.leader(f), other = sides.leader(n + f);
      if (side != other && size[side] < size[other]) note(report_, MeshFault::reversed_face, f);
    }
  }

  /// Returns true if every vertex has at most one fan. (In 2D vertices take the role of edges and are
  /// classified as such.)
  bool judge_fans() {
    if (mesh_.dim == 2) return true;
    bool manifold = true;
    for (VertexId v = 0; v < fans_.size(); ++v) {
      // A vertex without fans is unused and does not count for Euler's formula.
      vertices_used_ += fans_[v] > 0;
      if (fans_[v] <= 1) continue;
      manifold = false;
      note(report_, MeshFault::non_manifold_vertex, v);
    }
    return manifold;
  }

  /// Returns the genus by Euler's formula: V - E + F = 2 C - 2 G.
  int genus() const {
    const std::int64_t euler = vertices_used_ - edges_ + faces_used_;
    return static_cast<int>((2 * std::int64_t{out_.components} - euler) / 2);
  }

  const Mesh& mesh_;
  MeshReport& report_;
  SurfaceTopology out_;
  std::vector<SideUse> sides_;
  std::vector<std::pair<std::uint32_t, FaceId>> open_;  ///< corners at which open edges start
  DisjointSets faces_;                                  ///< united over edges
  DisjointSets corners_;             ///< corners of all faces, united around their vertex: each set is a fan
  std::vector<std::uint32_t> fans_;  ///< (|V|) number of fans at a vertex: corners minus unions
  bool all_usable_ = false;
  std::int64_t vertices_used_ = 0, edges_ = 0, faces_used_ = 0;
};

}  // namespace

SurfaceTopology analyse_topology(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report) {
  return Analysis(mesh, use, report).run();
}

}  // namespace lrb
