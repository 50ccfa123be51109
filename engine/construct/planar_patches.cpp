// 1. Grow patches of faces in one plane, breadth first. Every decision is an exact predicate.
// 2. Merge the triangles of a patch one after another, each across one edge of the outline so far. What
//    remains of the edges inside is walked in both directions: it ends at vertices inside, or leads to holes.
// 3. Shorten the outline by the ends that it walks to and fro at once. Only the ways to holes are left.
// 4. Accept the polygon if its triangles are a part of the plane, and no corner of it is on another one.
// A first round takes whole patches, and leaves the triangles of those that lose vertices. A second one makes
// small polygons of all triangles.

#include "engine/construct/planar_patches.hpp"

#include <algorithm>
#include <array>

#include "engine/exact/plane_side.hpp"
#include "engine/mesh/polygon_shape.hpp"

namespace lrb::construct {
namespace {

using Slot = FrontMesh::Slot;
using Corner = FrontMesh::Corner;

/// One round: `most` triangles become one polygon; 0: whole patches are triangulated again.
class CoplanarMerger {
 public:
  CoplanarMerger(MergedFaces in, const std::vector<bool>& frozen, std::uint32_t most)
      : front_(in.mesh),
        in_(std::move(in)),
        frozen_(frozen),
        most_(most),
        patch_of_(front_.slot_count(), kNull),
        is_merged_(front_.slot_count()) {
    out_.mesh.vertices = polygon_.vertices = in_.mesh.vertices;
    out_.floors = in_.floors;
    // Copies of vertices follow those of the mesh. Another fan could touch a polygon in the middle there.
    shared_.resize(in_.mesh.vertices.size());
    for (auto c = static_cast<Corner>(shared_.size()); c < front_.point_count(); ++c)
      shared_[front_.point(c).id] = true;
    for (Slot s = 0; s < front_.slot_count(); ++s)
      if (patch_of_[s] == kNull) add_patch(s);
  }
  MergedFaces take() { return std::move(out_); }

 private:
  const double* at(Corner c) const { return front_.x(c).data(); }
  const double* at(VertexId v) const { return polygon_.vertices[v].data(); }

  void add_patch(Slot seed) {
    grow(seed);
    std::vector<FaceId> faces;
    for (const Slot s : slots_) faces.push_back(front_[s].face);
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    const auto add = [&](std::span<const VertexId> corners, MergedFaces::Origin origin) {
      out_.mesh.add_face(corners);
      out_.origin.push_back(origin);
    };
    if (faces.size() == 1 || !cut(outline(), faces.size())) {
      for (const FaceId f : faces) add(in_.mesh.face(f), in_.origin[f]);
      return;
    }
    MergedFaces::Origin origin = in_.origin[faces[0]];
    if (origin.region == kNull) {
      origin.region = static_cast<std::uint32_t>(out_.floors.size());
      out_.floors.emplace_back();
      for (const FaceId f : faces) out_.floors.back().push_back(in_.origin[f].face);
    }
    if (most_ > 0) return add(polygon_.face(0), origin);
    for (const auto& t : triangles_) add(t, origin);
  }

  /// Step 1: finds the triangles of a patch.
  void grow(Slot seed) {
    slots_.clear();
    const auto& t = front_[seed].v;
    const std::uint32_t region = in_.origin[front_[seed].face].region;
    axes_ = exact::axes_for(at(t[0]), at(t[1]), at(t[2]));
    const exact::PlaneSide plane(at(t[0]), at(t[1]), at(t[2]));
    const auto fits = [&](Slot s) {
      const auto& v = front_[s].v;
      return turn(at(v[0]), at(v[1]), at(v[2])) > 0 && std::all_of(v.begin(), v.end(), [&](Corner c) {
               // A corner of the plane would be the slow case of the predicate.
               const bool is_own = std::find(t.begin(), t.end(), c) != t.end();
               return !shared_[front_.point(c).id] && (is_own || plane.side(at(c)) == 0);
             });
    };
    const auto add_face = [&](Slot of, bool is_seed) {
      const auto [first, last] = front_.unit(of);
      const MergedFaces::Origin& origin = in_.origin[front_[of].face];
      bool good = axes_.turn != 0 && origin.region == region && (region != kNull || !frozen_[origin.face]) &&
                  (most_ == 0 || slots_.size() + (last - first) <= most_);
      for (Slot s = first; good && s < last; ++s) good = fits(s);
      if (!good && !is_seed) return;
      for (Slot s = first; s < last; ++s) patch_of_[s] = seed, slots_.push_back(s);
      if (!good) axes_.turn = 0;  // nothing is added to this face
    };
    add_face(seed, true);
    for (std::size_t i = 0; i < slots_.size(); ++i)
      for (const Slot s : front_[slots_[i]].across)
        if (patch_of_[s] == kNull) add_face(s, false);
  }

  /// Returns the orientation of a triangle in the plane of the patch: 1 as its seed's.
  int turn(const double* a, const double* b, const double* c) const {
    return axes_.turn * exact::orient_axes(a, b, c, axes_.x, axes_.y);
  }

  /// Steps 2 and 3.
  std::vector<VertexId> outline() {
    struct Side {
      Slot slot;
      int edge;
      std::uint32_t next;
    };
    const Slot seed = slots_[0];
    std::vector<Side> sides = {{seed, 0, 1}, {seed, 1, 2}, {seed, 2, 0}};
    std::vector<std::uint32_t> queue = {0, 1, 2};
    is_merged_[seed] = true;
    std::uint32_t start = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t k = queue[i];
      const Slot s = front_[sides[k].slot].across[sides[k].edge];
      if (patch_of_[s] != seed) {
        start = k;  // of the patch's own boundary, so that no end is there
        continue;
      }
      if (is_merged_[s]) continue;
      is_merged_[s] = true;
      // The side becomes the triangle's two other edges.
      const int j = front_.index_of(s, front_[sides[k].slot].v[sides[k].edge]);
      const auto fresh = static_cast<std::uint32_t>(sides.size());
      sides.push_back({s, (j + 1) % 3, sides[k].next});
      sides[k] = {s, j, fresh};
      queue.push_back(k);
      queue.push_back(fresh);
    }
    std::vector<VertexId> corners;
    std::uint32_t k = start;
    do {
      const VertexId v = front_.point(front_[sides[k].slot].v[sides[k].edge]).id;
      if (corners.size() > 1 && corners[corners.size() - 2] == v)
        corners.pop_back();
      else
        corners.push_back(v);
      k = sides[k].next;
    } while (k != start);
    while (corners.size() > 2 && corners[corners.size() - 2] == corners[0])
      corners.resize(corners.size() - 2);
    return corners;
  }

  /// Step 4. The triangles depend on the first corner. Returns false if no polygon is accepted, or if it has
  /// as many triangles as the patch has faces.
  bool cut(std::vector<VertexId> corners, std::size_t faces) {
    if (corners.size() > kMaxCorners || (most_ == 0 && corners.size() - 2 >= faces)) return false;
    for (std::size_t i = 0; i < std::min(corners.size(), kMaxTries); ++i) {
      polygon_.face_offsets.resize(1);
      polygon_.face_vertices.clear();
      polygon_.add_face(corners);
      triangulate(polygon_, 0, triangles_);
      if (std::all_of(triangles_.begin(), triangles_.end(), [&](const auto& t) { return is_free(t); }))
        return true;
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
    return false;
  }

  /// Returns true if a triangle has area and touches no corner of the outline but its own.
  bool is_free(const std::array<VertexId, 3>& t) const {
    const double *a = at(t[0]), *b = at(t[1]), *c = at(t[2]);
    const auto corners = polygon_.face(0);
    return turn(a, b, c) > 0 && std::none_of(corners.begin(), corners.end(), [&](VertexId v) {
             return v != t[0] && v != t[1] && v != t[2] && turn(a, b, at(v)) >= 0 && turn(b, c, at(v)) >= 0 &&
                    turn(c, a, at(v)) >= 0;
           });
  }

  static constexpr std::size_t kMaxCorners = 4096, kMaxTries = 16;

  const FrontMesh front_;
  const MergedFaces in_;
  const std::vector<bool>& frozen_;
  const std::uint32_t most_;
  std::vector<Slot> patch_of_;   ///< (slots) the seed of its patch
  std::vector<bool> is_merged_;  ///< (slots)
  std::vector<bool> shared_;     ///< (vertices) several fans have it
  MergedFaces out_;
  // The current patch.
  std::vector<Slot> slots_;
  exact::Axes axes_{};
  Mesh polygon_;  ///< with all vertices
  std::vector<std::array<VertexId, 3>> triangles_;
};

}  // namespace

MergedFaces merge_coplanar(const Mesh& mesh, const std::vector<bool>& frozen, std::uint32_t most) {
  MergedFaces merged;
  merged.mesh = mesh;
  for (FaceId f = 0; f < mesh.face_count(); ++f) merged.origin.push_back({f});
  for (const std::uint32_t triangles : {0u, most})
    merged = CoplanarMerger(std::move(merged), frozen, triangles).take();
  return merged;
}

}  // namespace lrb::construct
