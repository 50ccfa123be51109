// Merging of coincident vertices along open edges:
// 1. Find the first vertex at each position. Sort the sides of faces by the positions of their ends.
// 2. A side is open if all other sides at the same positions have different (merged) vertices.
// 3. Merge the ends of open sides that match one to one in opposite directions, until nothing changes.
// 4. Then merge all open sides at each position once. If that changed anything, return to step 3.
// 5. Replace each merged vertex by the smallest of its set.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "engine/mesh/vertex_groups.hpp"
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb {
namespace {

/// A side of a face (2D: an end of a segment), by the positions of its ends and by its vertices there.
struct PlacedSide {
  std::array<VertexId, 2> place{};   ///< smaller, larger position (2D: the same twice)
  std::array<VertexId, 2> vertex{};  ///< vertices at these positions
  bool forward = false;  ///< runs from the first to the second (2D: the segment starts at the position)
};

class CornerJoiner {
 public:
  explicit CornerJoiner(Mesh& mesh) : mesh_(mesh), sets_(mesh.vertices.size()), used_(mesh.vertices.size()) {}

  JoinedCorners run() {
    const bool all_distinct = find_places();
    mark_used();
    out_.before = out_.after = static_cast<std::uint32_t>(std::count(used_.begin(), used_.end(), true));
    // All vertices have distinct positions: nothing can be merged.
    if (all_distinct) return out_;
    sort_sides();
    out_.open_before = count_open();
    // Pairs to a fixed point first, because each merge may make further sides unambiguous. Each round merges
    // sets, so the loop terminates.
    do {
      while (join_groups(true)) {
      }
    } while (join_groups(false));
    out_.open_after = count_open();
    rename_corners();
    return out_;
  }

 private:
  /// The representatives of the vertices at a side's ends, and its index.
  using NamedSide = std::pair<std::array<std::uint32_t, 2>, std::size_t>;

  /// Returns true if all positions are distinct.
  bool find_places() {
    place_ = first_at_positions(mesh_.vertices);
    bool distinct = true;
    finite_.reserve(mesh_.vertices.size());
    for (VertexId v = 0; v < mesh_.vertices.size(); ++v) {
      finite_.push_back(mesh_.vertices[v].allFinite());
      distinct &= place_[v] == v;
    }
    return distinct;
  }

  bool can_be_used(FaceId f) const {
    const auto corners = mesh_.face(f);
    return std::all_of(corners.begin(), corners.end(),
                       [&](VertexId v) { return v < finite_.size() && finite_[v] != 0; });
  }

  void mark_used() {
    for (FaceId f = 0; f < mesh_.face_count(); ++f)
      if (can_be_used(f))
        for (const VertexId v : mesh_.face(f)) used_[v] = true;
  }

  /// Calls visit(smaller position, side) for each side of a usable face.
  template <class Visit>
  void for_each_side(const Visit& visit) const {
    for (FaceId f = 0; f < mesh_.face_count(); ++f) {
      if (!can_be_used(f)) continue;
      const auto corners = mesh_.face(f);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const VertexId v = corners[i], w = corners[i + 1 < corners.size() ? i + 1 : 0];
        // Sides between coincident vertices have no length and are skipped.
        const VertexId p = place_[v], q = place_[w];
        if (mesh_.dim == 2)
          visit(p, PlacedSide{{p, p}, {v, v}, i == 0});
        else if (p != q)
          visit(std::min(p, q), p < q ? PlacedSide{{p, q}, {v, w}, true} : PlacedSide{{q, p}, {w, v}, false});
      }
    }
  }

  void sort_sides() {
    VertexBuckets<PlacedSide> by_place(mesh_.vertices.size(),
                                       [&](const auto& visit) { for_each_side(visit); });
    by_place.for_each_group([](VertexId, std::span<PlacedSide> sides) {
      std::sort(sides.begin(), sides.end(),
                [](const PlacedSide& a, const PlacedSide& b) { return a.place[1] < b.place[1]; });
    });
    sides_ = std::move(by_place.items());
  }

  /// Calls visit(open) for each pair of positions with sides. open: the sides whose (merged) vertices no
  /// other side there shares.
  template <class Visit>
  void for_each_place(Visit visit) {
    std::vector<NamedSide> there;
    std::vector<const PlacedSide*> open;
    for (std::size_t i = 0, end = 0; i < sides_.size(); i = end) {
      there.clear();
      for (; end < sides_.size() && sides_[end].place == sides_[i].place; ++end)
        // Representatives change as sets are merged, so they are looked up at each visit.
        there.push_back({{sets_.leader(sides_[end].vertex[0]), sets_.leader(sides_[end].vertex[1])}, end});
      std::sort(there.begin(), there.end());
      open.clear();
      for (std::size_t k = 0; k < there.size(); ++k)
        // Open: the only side with these two vertices at these positions.
        if ((k == 0 || there[k - 1].first != there[k].first) &&
            (k + 1 == there.size() || there[k + 1].first != there[k].first))
          open.push_back(&sides_[there[k].second]);
      visit(open);
    }
  }

  std::uint32_t count_open() {
    std::size_t count = 0;
    for_each_place([&](const auto& open) { count += open.size(); });
    return static_cast<std::uint32_t>(count);
  }

  /// Merges the open sides at each pair of positions: if only_pairs, only where there are exactly two in
  /// opposite directions. Returns true if any were merged.
  bool join_groups(bool only_pairs) {
    bool any = false;
    for_each_place([&](const std::vector<const PlacedSide*>& open) {
      if (open.size() < 2 || (only_pairs && (open.size() > 2 || open[0]->forward == open[1]->forward)))
        return;
      // Both ends are merged, in the order of positions, which is independent of direction.
      for (const PlacedSide* side : open)
        for (int end = 0; end < 2; ++end) any |= sets_.join(open[0]->vertex[end], side->vertex[end]);
    });
    return any;
  }

  void rename_corners() {
    for (FaceId f = 0; f < mesh_.face_count(); ++f)
      if (can_be_used(f))
        for (std::uint32_t i = mesh_.face_offsets[f]; i < mesh_.face_offsets[f + 1]; ++i)
          mesh_.face_vertices[i] = VertexId(sets_.leader(mesh_.face_vertices[i]));
    // Vertices that do not represent their set are no longer referenced.
    for (VertexId v = 0; v < used_.size(); ++v)
      if (used_[v] && sets_.leader(v) != v) mesh_.joined.push_back(v);
    out_.after = out_.before - static_cast<std::uint32_t>(mesh_.joined.size());
  }

  Mesh& mesh_;
  DisjointSets sets_;  ///< sets of merged vertices
  std::vector<bool> used_;
  std::vector<VertexId> place_;  ///< (|V|) the position, named by the first vertex there
  std::vector<char> finite_;     ///< (|V|) all coordinates are finite
  std::vector<PlacedSide> sides_;
  JoinedCorners out_;
};

}  // namespace

JoinedCorners join_corners(Mesh& mesh) {
  const FloatMode float_mode;
  return CornerJoiner(mesh).run();
}

}  // namespace lrb
