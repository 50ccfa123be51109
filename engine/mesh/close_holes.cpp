// Hole filling with proof:
// 1. Find the boundary loops. Reverse each to the direction of its fill, and choose its axis of projection.
// 2. Fill planar loops that contain planar loops of the opposite orientation as rings: bridges join them to
//    one polygon, which is triangulated by ear clipping.
// 3. Fill all others individually. Candidates: minimum-area triangulation (Klincsek 1980; used for holes by
//    Barequet and Sharir 1995), ear clipping, fan around the centroid.
// 4. Candidates are tried in rounds. A round adds the current candidate of each hole to a copy of the mesh,
//    finds all intersections at once, and accepts candidates greedily in order. The others proceed to their
//    next candidate.

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/geometry.hpp"
#include "engine/mesh/hole_fill.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include "engine/mesh/self_intersections.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb {
namespace {

using Edge = std::array<VertexId, 2>;
using Edges = std::set<Edge>;

Edge edge_of(VertexId v, VertexId w) {
  return {std::min(v, w), std::max(v, w)};
}

/// Triangles of fills are higher, relative to their longest edge. Rounded T-junctions are not.
constexpr double kThinnest = 1e-6;

/// A fill in progress: the holes that it fills, its candidates, and the current one.
struct Attempt {
  std::vector<std::size_t> holes;  ///< the first one encloses the others
  std::vector<std::optional<HoleFill>> ways;
  std::size_t fill_choice = 0;
  const HoleFill& lid() const { return *ways[fill_choice]; }
};

class HoleCloser {
 public:
  explicit HoleCloser(const CheckedMesh& mesh) : checked_(mesh), mesh_(mesh.mesh()), use_(mesh.use()) {
    // Holes are the boundary loops; edges_ contains all edges that a fill must not duplicate.
    for (BoundaryLoop& loop : find_boundary_loops(mesh_, use_)) out_.holes.push_back({std::move(loop)});
    for (FaceId f = 0; f < mesh_.face_count(); ++f) {
      const auto corners = mesh_.face(f);
      if (use_[f] == FaceUse::nothing) continue;
      for (std::size_t i = 0; i < corners.size(); ++i)
        edges_.insert(edge_of(corners[i], corners[(i + 1) % corners.size()]));
    }
    out_.mesh = mesh_;
  }

  ClosedHoles run() {
    // Rings before single holes: a disk over an outer loop would block the ring.
    for (std::size_t i = 0; i < out_.holes.size(); ++i) look_at(i);
    try_all(rings());
    // Holes not filled by a ring.
    std::vector<Attempt> alone;
    for (std::size_t i = 0; i < out_.holes.size(); ++i)
      if (views_[i] && !is_closed(i)) alone.push_back(attempt_for(i));
    try_all(std::move(alone));
    for (Hole& hole : out_.holes) hole.of_sheet = checked_.is_of_sheet(hole.loop.face);
    out_.new_faces = static_cast<std::uint32_t>(out_.mesh.face_count() - mesh_.face_count());
    out_.new_vertices = static_cast<std::uint32_t>(out_.mesh.vertices.size() - mesh_.vertices.size());
    return std::move(out_);
  }

 private:
  bool is_closed(std::size_t i) const { return out_.holes[i].state <= HoleState::closed_as_ring; }

  /// Computes the loop in the direction of its fill, and its projection.
  void look_at(std::size_t i) {
    Hole& hole = out_.holes[i];
    // The fill's faces traverse the boundary edges opposite to the faces along the loop.
    rims_.emplace_back(hole.loop.vertices.rbegin(), hole.loop.vertices.rend());
    views_.emplace_back();
    // Each check that passes advances the state, which thus always states why the hole is still open.
    if (!hole.loop.is_loop || !hole.loop.box.sizes().allFinite()) return;
    hole.state = HoleState::no_area;
    if (!spanning_corners(mesh_, rims_[i])) return;
    hole.state = HoleState::meets_itself;
    views_[i] = view_of(mesh_, rims_[i]);
  }

  /// Returns an attempt for each planar hole that contains planar holes of opposite orientation.
  std::vector<Attempt> rings() const {
    // Assign each hole to the smallest one around it. Of holes in holes, every second one is outside a ring.
    std::vector<std::vector<std::size_t>> inner(rims_.size());
    std::vector<std::optional<std::size_t>> homes;
    for (std::size_t i = 0; i < rims_.size(); ++i)
      if (const auto home = homes.emplace_back(home_of(i))) inner[*home].push_back(i);
    std::vector<bool> is_inner(rims_.size(), false);
    for (std::size_t i = 0; i < rims_.size(); ++i)
      for (auto [up, n] = std::pair(homes[i], std::size_t{0}); up && n < rims_.size(); up = homes[*up], ++n)
        is_inner[i] = !is_inner[i];
    std::vector<Attempt> out;
    for (std::size_t i = 0; i < rims_.size(); ++i) {
      if (inner[i].empty() || is_inner[i]) continue;
      std::vector<std::vector<VertexId>> holes;
      for (const std::size_t k : inner[i]) holes.push_back(rims_[k]);
      // Connect the inner loops to the outer one by bridges. The result is one polygon that may visit
      // vertices twice.
      const auto rim = bridge_holes(mesh_, rims_[i], std::move(holes), *views_[i]);
      if (!rim) continue;
      Attempt& ring = out.emplace_back();
      ring.holes = {i};
      ring.holes.insert(ring.holes.end(), inner[i].begin(), inner[i].end());
      ring.ways = {cut_corners(mesh_, *rim, *views_[i], allowed())};
    }
    return out;
  }

  /// Returns the smallest hole around a planar one, coplanar and of opposite orientation; nullopt if there is
  /// none.
  std::optional<std::size_t> home_of(std::size_t i) const {
    if (!views_[i] || !out_.holes[i].loop.planar) return std::nullopt;
    const auto size = [&](std::size_t k) { return norm3(out_.holes[k].loop.box.diagonal()); };
    std::optional<std::size_t> home;
    for (std::size_t k = 0; k < rims_.size(); ++k) {
      // Swapped projections: the same axis and opposite orientation.
      const bool opposite = views_[k] && views_[i]->x == views_[k]->y && views_[i]->y == views_[k]->x;
      if (!opposite || !out_.holes[k].loop.planar || (home && size(*home) <= size(k))) continue;
      // Exact tests: coplanar, and inside the polygon. Boundary loops may touch, so the test of one vertex is
      // preliminary; the final proof decides.
      if (is_planar(mesh_, rims_[i], *spanning_corners(mesh_, rims_[k])) &&
          lies_inside(mesh_, rims_[k], rims_[i][0], *views_[k]))
        home = k;
    }
    return home;
  }

  /// Returns a predicate that rejects second edges between two vertices: they would have four faces.
  EdgeAllowed allowed() const {
    return [this](VertexId v, VertexId w) { return v != w && !edges_.contains(edge_of(v, w)); };
  }

  Attempt attempt_for(std::size_t i) const {
    Attempt a;
    a.holes = {i};
    // All triangulations of a planar polygon have the same area, so only non-planar loops are optimised.
    if (!out_.holes[i].loop.planar) a.ways.push_back(least_area(mesh_, rims_[i], allowed()));
    a.ways.push_back(cut_corners(mesh_, rims_[i], *views_[i], allowed()));
    // A triangle needs no extra vertex.
    if (rims_[i].size() > 3) a.ways.push_back(fan_about_centroid(mesh_, rims_[i]));
    return a;
  }

  /// Tries the candidates of each attempt in order until one is accepted or none is left.
  void try_all(std::vector<Attempt> attempts) {
    while (!attempts.empty()) {
      // Skip candidates that do not exist or whose inner edges are no longer free. Every round advances each
      // attempt, so the loop terminates.
      for (Attempt& a : attempts)
        while (a.fill_choice < a.ways.size() &&
               !(a.ways[a.fill_choice] && edges_are_free(a.lid()) && has_area(a)))
          ++a.fill_choice;
      std::erase_if(attempts, [](const Attempt& a) { return a.fill_choice == a.ways.size(); });
      if (!attempts.empty()) try_round(attempts);
    }
  }

  /// Returns the edges of a fill that connect two vertices of its loop and are not part of the loop.
  static Edges inner_edges(const HoleFill& lid) {
    // An edge of two triangles is an inner edge; an edge of the boundary loop occurs once. A bridge counts as
    // inner. Spokes of a fan end at a new vertex and cannot coincide with existing edges.
    Edges once, twice;
    for (const auto& t : lid.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge e = edge_of(t[i], t[(i + 1) % 3]);
        if (e[1] != kCentroid && !once.insert(e).second) twice.insert(e);
      }
    return twice;
  }

  bool edges_are_free(const HoleFill& lid) const {
    const Edges inner = inner_edges(lid);
    return std::none_of(inner.begin(), inner.end(), [&](const Edge& e) { return edges_.contains(e); });
  }

  /// Returns true if every triangle of the current candidate has area; else its hole says so.
  bool has_area(const Attempt& a) {
    const auto x = [&](VertexId v) { return v == kCentroid ? *a.lid().centroid : mesh_.vertices[v]; };
    const bool flat = std::ranges::any_of(a.lid().triangles, [&](const auto& t) {
      return !(relative_height(x(t[0]), x(t[1]), x(t[2])) > kThinnest);
    });
    HoleState& state = out_.holes[a.holes[0]].state;
    if (flat && state == HoleState::meets_itself) state = HoleState::no_area;
    return !flat;
  }

  /// The intersections of one candidate: with itself, with a face of the mesh, with other candidates.
  struct Meetings {
    bool itself = false;
    std::optional<FaceId> face;
    std::vector<std::size_t> lids;
  };

  /// Adds the current candidates of all attempts at once, finds their intersections, and accepts the valid
  /// ones. If two of them intersect, the earlier one is accepted.
  void try_round(std::vector<Attempt>& attempts) {
    // Pass 1: add the candidates of all attempts to a copy of the mesh.
    Mesh trial = out_.mesh;
    std::vector<std::size_t> owner;  // for each new face: its attempt
    for (std::size_t i = 0; i < attempts.size(); ++i) {
      add(attempts[i].lid(), trial);
      owner.resize(trial.face_count() - out_.mesh.face_count(), i);
    }
    // Pass 2: one search for all intersections that involve new faces.
    const std::vector<Meetings> meetings = find_meetings(trial, owner, attempts.size());
    // Pass 3: greedy choice. A candidate conflicts only with faces of the mesh, with itself, and with
    // candidates accepted before it.
    std::vector<bool> accepted(attempts.size(), false);
    for (std::size_t i = 0; i < attempts.size(); ++i) {
      const auto in_way = std::find_if(meetings[i].lids.begin(), meetings[i].lids.end(),
                                       [&](std::size_t k) { return accepted[k]; });
      Hole& hole = out_.holes[attempts[i].holes[0]];
      if (meetings[i].face) {
        hole.state = HoleState::meets_surface;
        hole.obstacle = *meetings[i].face;
        if (*meetings[i].face >= mesh_.face_count()) blame_lid(hole, *meetings[i].face);
      } else if (in_way != meetings[i].lids.end()) {
        hole.state = HoleState::meets_lid;
        hole.obstacle = static_cast<std::uint32_t>(attempts[*in_way].holes[0]);
      } else if (meetings[i].itself || !edges_are_free(attempts[i].lid())) {
        hole.state = HoleState::meets_itself;
        hole.obstacle = kNull;
      } else {
        // The inner edges were checked again above, because an earlier candidate of this round may have added
        // one.
        accepted[i] = true;
        keep(attempts[i]);
      }
      attempts[i].fill_choice = accepted[i] ? attempts[i].ways.size() : attempts[i].fill_choice + 1;
    }
  }

  /// The obstructing face belongs to a fill: reports the hole of that fill instead.
  void blame_lid(Hole& hole, FaceId face) const {
    hole.state = HoleState::meets_lid;
    for (std::size_t i = 0; i < out_.holes.size(); ++i)
      if (is_closed(i) && face >= out_.holes[i].first_face &&
          face < out_.holes[i].first_face + out_.holes[i].faces)
        hole.obstacle = static_cast<std::uint32_t>(i);
  }

  std::vector<Meetings> find_meetings(const Mesh& trial, const std::vector<std::size_t>& owner,
                                      std::size_t attempts) const {
    std::vector<FaceUse> use = use_;
    // New faces are triangles, so they are planar and convex.
    use.resize(trial.face_count(), FaceUse::convex);
    const auto standing = static_cast<std::uint32_t>(out_.mesh.face_count());
    std::vector<Meetings> out(attempts);
    find_self_intersections(
        trial, use,
        [&](FaceId f, FaceId g) {
          Meetings& of_g = out[owner[g - standing]];
          if (f < standing) {
            // The smallest face number is reported, independent of the order of the search.
            of_g.face = of_g.face ? std::min(*of_g.face, f) : f;
          } else if (owner[f - standing] == owner[g - standing]) {
            of_g.itself = true;
          } else {
            of_g.lids.push_back(owner[f - standing]);
            out[owner[f - standing]].lids.push_back(owner[g - standing]);
          }
        },
        FaceMeeting::outside_shared,
        // Pairs have f < g, so g is new if either is. Pairs of existing faces are faults of the input.
        [&](FaceId, FaceId g) { return g >= standing; });
    for (Meetings& of_one : out) std::sort(of_one.lids.begin(), of_one.lids.end());
    return out;
  }

  static void add(const HoleFill& lid, Mesh& mesh) {
    const auto centroid = static_cast<VertexId>(mesh.vertices.size());
    // The centre of a fan becomes a new vertex, which replaces kCentroid.
    if (lid.centroid) mesh.vertices.push_back(*lid.centroid);
    for (std::array<VertexId, 3> t : lid.triangles) {
      std::replace(t.begin(), t.end(), kCentroid, centroid);
      mesh.add_face(t);
    }
  }

  void keep(const Attempt& a) {
    for (const std::size_t i : a.holes) {
      Hole& hole = out_.holes[i];
      hole.state = a.holes.size() == 1 ? HoleState::closed : HoleState::closed_as_ring;
      hole.obstacle = kNull;
      hole.first_face = static_cast<std::uint32_t>(out_.mesh.face_count());
      hole.faces = static_cast<std::uint32_t>(a.lid().triangles.size());
    }
    for (const Edge& e : inner_edges(a.lid())) edges_.insert(e);
    add(a.lid(), out_.mesh);
  }

  const CheckedMesh& checked_;
  const Mesh& mesh_;
  const std::vector<FaceUse>& use_;
  Edges edges_;                                       ///< edges of existing faces
  std::vector<std::vector<VertexId>> rims_;           ///< (holes) in the direction of the fill
  std::vector<std::optional<HoleProjection>> views_;  ///< (holes) nullopt: cannot be filled
  ClosedHoles out_;
};

}  // namespace

ClosedHoles close_holes(const CheckedMesh& mesh) {
  const FloatMode float_mode;
  return HoleCloser(mesh).run();
}

}  // namespace lrb
