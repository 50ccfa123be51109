#include "engine/mesh/close_holes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "engine/exact/predicates.hpp"
#include "engine/mesh/lid_triangles.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include "engine/mesh/self_intersections.hpp"

namespace lrb {
namespace {

using lids::Lid;
using Edge = std::array<VertexId, 2>;
using Edges = std::set<Edge>;

Edge edge_of(VertexId v, VertexId w) {
  return {std::min(v, w), std::max(v, w)};
}

/// A lid that is tried: what it closes, the ways to make it that are left, and the one that is tried now.
struct Attempt {
  std::vector<std::size_t> holes;  ///< the first is the one round the others
  std::vector<std::optional<Lid>> ways;
  std::size_t way = 0;
  const Lid& lid() const { return *ways[way]; }
};

class HoleCloser {
 public:
  explicit HoleCloser(const CheckedMesh& mesh) : checked_(mesh), mesh_(mesh.mesh()), use_(mesh.use()) {
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
    for (std::size_t i = 0; i < out_.holes.size(); ++i) look_at(i);
    try_all(rings());
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

  /// Fills in the rim as its lid has to run, and how to see it.
  void look_at(std::size_t i) {
    Hole& hole = out_.holes[i];
    rims_.emplace_back(hole.loop.vertices.rbegin(), hole.loop.vertices.rend());
    views_.emplace_back();
    if (!hole.loop.is_loop || !hole.loop.box.sizes().allFinite()) return;
    hole.state = HoleState::no_area;
    if (!spanning_corners(mesh_, rims_[i])) return;
    hole.state = HoleState::meets_itself;
    views_[i] = lids::view_of(mesh_, rims_[i]);
  }

  /// Returns an attempt for each flat hole that has flat holes in it which run the other way round.
  std::vector<Attempt> rings() const {
    std::vector<std::vector<std::size_t>> inner(rims_.size());
    for (std::size_t i = 0; i < rims_.size(); ++i)
      if (const auto home = home_of(i)) inner[*home].push_back(i);
    std::vector<Attempt> out;
    for (std::size_t i = 0; i < rims_.size(); ++i) {
      if (inner[i].empty()) continue;
      std::vector<std::vector<VertexId>> holes;
      for (const std::size_t k : inner[i]) holes.push_back(rims_[k]);
      const auto rim = lids::bridge_holes(mesh_, rims_[i], std::move(holes), *views_[i]);
      if (!rim) continue;
      Attempt& ring = out.emplace_back();
      ring.holes = {i};
      ring.holes.insert(ring.holes.end(), inner[i].begin(), inner[i].end());
      ring.ways = {lids::cut_corners(mesh_, *rim, *views_[i], allowed())};
    }
    return out;
  }

  /// Returns the smallest hole round a flat one, in its plane and running the other way.
  std::optional<std::size_t> home_of(std::size_t i) const {
    if (!views_[i] || !out_.holes[i].loop.planar) return std::nullopt;
    const auto size = [&](std::size_t k) { return out_.holes[k].loop.box.diagonal().norm(); };
    std::optional<std::size_t> home;
    for (std::size_t k = 0; k < rims_.size(); ++k) {
      const bool opposite = views_[k] && views_[i]->x == views_[k]->y && views_[i]->y == views_[k]->x;
      if (!opposite || !out_.holes[k].loop.planar || (home && size(*home) <= size(k))) continue;
      if (is_planar(mesh_, rims_[i], *spanning_corners(mesh_, rims_[k])) &&
          lids::lies_inside(mesh_, rims_[k], rims_[i][0], *views_[k]))
        home = k;
    }
    return home;
  }

  /// No second edge between two vertices: it would have four faces.
  lids::EdgeAllowed allowed() const {
    return [this](VertexId v, VertexId w) { return v != w && !edges_.contains(edge_of(v, w)); };
  }

  Attempt attempt_for(std::size_t i) const {
    Attempt a;
    a.holes = {i};
    if (!out_.holes[i].loop.planar) a.ways.push_back(lids::least_area(mesh_, rims_[i], allowed()));
    a.ways.push_back(lids::cut_corners(mesh_, rims_[i], *views_[i], allowed()));
    if (rims_[i].size() > 3) a.ways.push_back(lids::fan_about_middle(mesh_, rims_[i]));
    return a;
  }

  /// Tries the ways of each attempt, one after the other, until one stands or none is left.
  void try_all(std::vector<Attempt> attempts) {
    while (!attempts.empty()) {
      for (Attempt& a : attempts)
        while (a.way < a.ways.size() && !(a.ways[a.way] && edges_are_free(a.lid()))) ++a.way;
      std::erase_if(attempts, [](const Attempt& a) { return a.way == a.ways.size(); });
      if (!attempts.empty()) try_round(attempts);
    }
  }

  /// Returns the edges of a lid that join two vertices of its rim, without being a part of it.
  static Edges inner_edges(const Lid& lid) {
    Edges once, twice;
    for (const auto& t : lid.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge e = edge_of(t[i], t[(i + 1) % 3]);
        if (e[1] != lids::kMiddle && !once.insert(e).second) twice.insert(e);
      }
    return twice;
  }

  bool edges_are_free(const Lid& lid) const {
    const Edges inner = inner_edges(lid);
    return std::none_of(inner.begin(), inner.end(), [&](const Edge& e) { return edges_.contains(e); });
  }

  /// What a lid was found to meet: nothing, a face that stands, or other lids of the round.
  struct Meetings {
    bool itself = false;
    std::optional<FaceId> face;
    std::vector<std::size_t> lids;
  };

  /// Puts the lids of all attempts on at once, sees what they meet, and keeps those that stand: an earlier
  /// one before a later one that it meets.
  void try_round(std::vector<Attempt>& attempts) {
    Mesh trial = out_.mesh;
    std::vector<std::size_t> owner;  // of new faces: the attempt
    for (std::size_t i = 0; i < attempts.size(); ++i) {
      add(attempts[i].lid(), trial);
      owner.resize(trial.face_count() - out_.mesh.face_count(), i);
    }
    const std::vector<Meetings> meetings = find_meetings(trial, owner, attempts.size());
    std::vector<bool> stands(attempts.size(), false);
    for (std::size_t i = 0; i < attempts.size(); ++i) {
      const auto in_way = std::find_if(meetings[i].lids.begin(), meetings[i].lids.end(),
                                       [&](std::size_t k) { return stands[k]; });
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
        stands[i] = true;
        keep(attempts[i]);
      }
      attempts[i].way = stands[i] ? attempts[i].ways.size() : attempts[i].way + 1;
    }
  }

  /// The face in the way is of a lid: names that lid's hole.
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
    use.resize(trial.face_count(), FaceUse::convex);
    const auto standing = static_cast<std::uint32_t>(out_.mesh.face_count());
    std::vector<Meetings> out(attempts);
    find_self_intersections(
        trial, use, [&](FaceId, FaceId g) { return g >= standing; },
        [&](FaceId f, FaceId g) {
          Meetings& of_g = out[owner[g - standing]];
          if (f < standing) {
            of_g.face = of_g.face ? std::min(*of_g.face, f) : f;
          } else if (owner[f - standing] == owner[g - standing]) {
            of_g.itself = true;
          } else {
            of_g.lids.push_back(owner[f - standing]);
            out[owner[f - standing]].lids.push_back(owner[g - standing]);
          }
        });
    return out;
  }

  static void add(const Lid& lid, Mesh& mesh) {
    const auto middle = static_cast<VertexId>(mesh.vertices.size());
    if (lid.middle) mesh.vertices.push_back(*lid.middle);
    for (std::array<VertexId, 3> t : lid.triangles) {
      std::replace(t.begin(), t.end(), lids::kMiddle, middle);
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
  Edges edges_;                                      ///< those that faces have
  std::vector<std::vector<VertexId>> rims_;          ///< (holes) as their lids have to run
  std::vector<std::optional<lids::LidView>> views_;  ///< (holes) empty: it cannot be closed
  ClosedHoles out_;
};

}  // namespace

ClosedHoles close_holes(const CheckedMesh& mesh) {
  return HoleCloser(mesh).run();
}

}  // namespace lrb
