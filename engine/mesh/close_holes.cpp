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
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include "engine/mesh/self_intersections.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_repair.hpp>

namespace lrb {
namespace {

// Triangulations of a polygon in 3D, in a projection along one axis:
// 1. cut_corners(): ear clipping (Meisters 1975), best-shaped ear first, with exact orientation tests.
// 2. least_area(): minimum-area triangulation by dynamic programming (Klincsek 1980), O(n^3).
// 3. fan_about_centroid(): a fan around the centroid of the vertices.
// 4. bridge_holes(): merges holes into the outer polygon along the shortest visible bridges, for ear
//    clipping.

/// Placeholder for the new vertex at the centre of a fan.
constexpr VertexId kCentroid(kNull.kValue - 1);

/// A hole fill.
struct HoleFill {
  std::vector<std::array<VertexId, 3>> triangles;
  std::optional<Eigen::Vector3d> centroid;  ///< position of kCentroid
};

/// Returns true if a triangulation may contain this edge as a diagonal.
using EdgeAllowed = std::function<bool(VertexId, VertexId)>;

/// Two coordinates of a projection in which a polygon is counter-clockwise.
struct HoleProjection {
  int x = 0, y = 1;
};

using Eigen::Vector3d;

/// Returns the sign of the orientation of a, b, c in a projection: +1 if c is left of the line from a to b.
/// Exact.
int turn(const Mesh& mesh, const HoleProjection& view, VertexId a, VertexId b, VertexId c) {
  const auto& x = mesh.vertices;
  return exact::orient_axes(x[a].data(), x[b].data(), x[c].data(), view.x, view.y);
}

class CornerCutter {
 public:
  CornerCutter(const Mesh& mesh, std::span<const VertexId> rim, const HoleProjection& view,
               const EdgeAllowed& allowed)
      : mesh_(mesh),
        view_(view),
        allowed_(allowed),
        rim_(rim.begin(), rim.end()),
        worth_(rim.size(), kUnknown) {}

  std::optional<HoleFill> run() {
    HoleFill lid;
    // Cut the best ear. Values are cached: cutting an ear changes only the triangles of its two neighbours.
    while (rim_.size() > 3) {
      std::size_t best = find_best();
      // No cached ear is left. Vertices that blocked others may be gone, so evaluate all once more.
      if (worth_[best] <= 0) {
        std::fill(worth_.begin(), worth_.end(), kUnknown);
        best = find_best();
        if (worth_[best] <= 0) return std::nullopt;
      }
      lid.triangles.push_back({at(best, -1), rim_[best], at(best, +1)});
      erase(best);
    }
    // The last triangle must have the orientation of the others.
    if (turn(mesh_, view_, rim_[0], rim_[1], rim_[2]) <= 0) return std::nullopt;
    lid.triangles.push_back({rim_[0], rim_[1], rim_[2]});
    return lid;
  }

 private:
  static constexpr double kUnknown = -1;

  VertexId at(std::size_t i, int step) const {
    return rim_[(i + rim_.size() + static_cast<std::size_t>(step)) % rim_.size()];
  }

  void erase(std::size_t i) {
    // The new diagonal changes the angles at both neighbours.
    rim_.erase(rim_.begin() + static_cast<std::ptrdiff_t>(i));
    worth_.erase(worth_.begin() + static_cast<std::ptrdiff_t>(i));
    worth_[i % rim_.size()] = worth_[(i + rim_.size() - 1) % rim_.size()] = kUnknown;
  }

  std::size_t find_best() {
    for (std::size_t i = 0; i < rim_.size(); ++i)
      if (worth_[i] == kUnknown) worth_[i] = worth(i);
    return static_cast<std::size_t>(std::max_element(worth_.begin(), worth_.end()) - worth_.begin());
  }

  /// Returns the quality of the ear's triangle, or 0 if the corner cannot be cut off.
  double worth(std::size_t i) const {
    // Not an ear: a reflex or straight corner, or a diagonal that is not allowed.
    const VertexId a = at(i, -1), b = rim_[i], c = at(i, +1);
    if (a == c || turn(mesh_, view_, a, b, c) <= 0 || (rim_.size() > 3 && !allowed_(a, c))) return 0;
    // Not an ear: another vertex is in the closed triangle. A second visit of a corner (end of a bridge) is
    // skipped by its index.
    for (const VertexId v : rim_)
      if (v != a && v != b && v != c && turn(mesh_, view_, a, b, v) >= 0 &&
          turn(mesh_, view_, b, c, v) >= 0 && turn(mesh_, view_, c, a, v) >= 0)
        return 0;
    const auto& x = mesh_.vertices;
    // Shape: height divided by the longest edge, 0 for needles, 0.87 for equilateral triangles.
    const double longest = std::max({norm3(x[a] - x[b]), norm3(x[b] - x[c]), norm3(x[c] - x[a])});
    const double area = norm3((x[b] - x[a]).cross(x[c] - x[a]));
    const double shape = area / longest / longest;
    // Ears are proven by exact tests, so numerical errors must not exclude one.
    return std::isfinite(shape) && shape > 0 ? shape : std::numeric_limits<double>::min();
  }

  const Mesh& mesh_;
  const HoleProjection& view_;
  const EdgeAllowed& allowed_;
  std::vector<VertexId> rim_;  ///< the remaining polygon
  std::vector<double> worth_;
};

/// Returns true if the open segment from a to b crosses or touches the closed one from c to d, which may
/// share ends with it.
bool is_blocked(const Mesh& mesh, const HoleProjection& view, VertexId a, VertexId b, VertexId c,
                VertexId d) {
  // An end of cd in the interior of ab counts as touching.
  const auto between = [&](VertexId v) {
    if (v == a || v == b || turn(mesh, view, a, b, v) != 0) return false;
    const auto& x = mesh.vertices;
    const int k = x[a][view.x] != x[b][view.x] ? view.x : view.y;
    return (x[v][k] > std::min(x[a][k], x[b][k])) && (x[v][k] < std::max(x[a][k], x[b][k]));
  };
  if (between(c) || between(d)) return true;
  // A common end: except for the cases above, the segments share only that end.
  if (a == c || a == d || b == c || b == d) return false;
  // Proper crossing: each segment has its ends on both sides of the other.
  return turn(mesh, view, a, b, c) * turn(mesh, view, a, b, d) < 0 &&
         turn(mesh, view, c, d, a) * turn(mesh, view, c, d, b) < 0;
}

bool is_blocked_by(const Mesh& mesh, const HoleProjection& view, VertexId a, VertexId b,
                   std::span<const VertexId> rim) {
  for (std::size_t i = 0; i < rim.size(); ++i)
    if (is_blocked(mesh, view, a, b, rim[i], rim[(i + 1) % rim.size()])) return true;
  return false;
}

/// Returns true if the segment from the polygon's i-th corner to b starts into the polygon.
bool leaves_inward(const Mesh& mesh, const HoleProjection& view, std::span<const VertexId> rim, std::size_t i,
                   VertexId b) {
  // Local cone test (O'Rourke, Computational Geometry in C): left of both edges at a convex corner, left of
  // one at a reflex corner.
  const VertexId before = rim[(i + rim.size() - 1) % rim.size()], v = rim[i],
                 after = rim[(i + 1) % rim.size()];
  const bool left_of_in = turn(mesh, view, before, v, b) > 0, left_of_out = turn(mesh, view, v, after, b) > 0;
  return turn(mesh, view, before, v, after) > 0 ? left_of_in && left_of_out : left_of_in || left_of_out;
}

struct Bridge {
  std::size_t hole = 0, from = 0, to = 0;  ///< number of the hole; corner of the polygon, corner of the hole
  double length_sq = 0;
};

/// Holes with more corner pairs than this are not closed, to bound the running time.
constexpr std::size_t kMaxBridges = 4'000'000;

/// Returns the shortest bridge that intersects no edge, or nullopt if there is none.
std::optional<Bridge> find_bridge(const Mesh& mesh, std::span<const VertexId> rim,
                                  const std::vector<std::vector<VertexId>>& holes,
                                  const HoleProjection& view) {
  // All pairs of a corner of the polygon and a corner of a hole, shortest first. The stable sort keeps ties
  // in a fixed order.
  std::size_t corners = 0;
  for (const auto& hole : holes) corners += hole.size();
  if (corners * rim.size() > kMaxBridges) return std::nullopt;
  std::vector<Bridge> bridges;
  for (std::size_t h = 0; h < holes.size(); ++h)
    for (std::size_t k = 0; k < holes[h].size(); ++k)
      for (std::size_t i = 0; i < rim.size(); ++i)
        bridges.push_back({h, i, k, squared_norm3(mesh.vertices[rim[i]] - mesh.vertices[holes[h][k]])});
  std::stable_sort(bridges.begin(), bridges.end(),
                   [](const Bridge& a, const Bridge& b) { return a.length_sq < b.length_sq; });
  // The first visible pair: it starts into the polygon and intersects no edge of the polygon or of any hole.
  for (const Bridge& bridge : bridges) {
    const VertexId a = rim[bridge.from], b = holes[bridge.hole][bridge.to];
    const auto in_way = [&](const auto& hole) { return is_blocked_by(mesh, view, a, b, hole); };
    if (leaves_inward(mesh, view, rim, bridge.from, b) && !is_blocked_by(mesh, view, a, b, rim) &&
        std::none_of(holes.begin(), holes.end(), in_way))
      return bridge;
  }
  return std::nullopt;
}

/// Returns the projection of a loop along the axis closest to its mean normal, or nullopt if it has no area.
std::optional<HoleProjection> view_of(const Mesh& mesh, std::span<const VertexId> rim) {
  // Vector area of the polygon's fan (Newell). Its largest component gives the axis of projection.
  Vector3d normal = Vector3d::Zero();
  const Vector3d o = mesh.vertices[rim[0]];
  for (std::size_t i = 1; i + 1 < rim.size(); ++i)
    normal += (mesh.vertices[rim[i]] - o).cross(mesh.vertices[rim[i + 1]] - o);
  int axis = 0;
  if (!(normal.cwiseAbs().maxCoeff(&axis) > 0) || !normal.allFinite()) return std::nullopt;
  // Swap the axes if the polygon would be clockwise.
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  return normal[axis] > 0 ? HoleProjection{x, y} : HoleProjection{y, x};
}

/// Triangulates a polygon by ear clipping in a projection. Exact: all triangles of a planar simple polygon
/// are inside it and have area. A vertex may occur twice (the ends of a bridge to a hole). Returns nullopt if
/// no ear is left.
std::optional<HoleFill> cut_corners(const Mesh& mesh, std::span<const VertexId> rim,
                                    const HoleProjection& view, const EdgeAllowed& allowed) {
  return CornerCutter(mesh, rim, view, allowed).run();
}

constexpr std::size_t kMaxForLeastArea = 256;  ///< the time is cubic
/// Returns the minimum-area triangulation, or nullopt if there is none or the loop has more than
/// kMaxForLeastArea vertices.
std::optional<HoleFill> least_area(const Mesh& mesh, std::span<const VertexId> rim,
                                   const EdgeAllowed& allowed) {
  const std::size_t n = rim.size();
  if (n > kMaxForLeastArea) return std::nullopt;
  const auto x = [&](std::size_t i) -> const Vector3d& { return mesh.vertices[rim[i]]; };
  // Twice the area, which orders triangulations equally. Triangles without area are excluded exactly.
  const auto area = [&](std::size_t i, std::size_t k, std::size_t j) {
    if (exact::collinear3d(x(i).data(), x(k).data(), x(j).data())) return kInfinity;
    return norm3((x(k) - x(i)).cross(x(j) - x(i)));
  };
  // cost[i n + j]: minimum area between the polygon from i to j and the edge that closes it (Klincsek 1980).
  std::vector<double> cost(n * n, 0);
  std::vector<std::size_t> third(n * n, 0);
  // By increasing length of the part, so that both smaller parts are known.
  for (std::size_t span = 2; span < n; ++span)
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      double& best = cost[i * n + j] = kInfinity;
      // The edge from the first to the last vertex is a side of the polygon, not a diagonal.
      if (span + 1 < n && !allowed(rim[i], rim[j])) continue;
      for (std::size_t k = i + 1; k < j; ++k) {
        // The parts alone cost too much: skip the triangle.
        const double rest = cost[i * n + k] + cost[k * n + j];
        if (!(rest < best)) continue;
        const double sum = rest + area(i, k, j);
        if (sum < best) best = sum, third[i * n + j] = k;
      }
    }
  if (!(cost[n - 1] < kInfinity)) return std::nullopt;
  // Backtracking: split each part at its best third vertex, with an explicit stack instead of recursion.
  HoleFill lid;
  std::vector<std::array<std::size_t, 2>> open = {{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = third[i * n + j];
    lid.triangles.push_back({rim[i], rim[k], rim[j]});
    open.push_back({i, k});
    open.push_back({k, j});
  }
  return lid;
}

/// Returns the fan around the centroid of the loop's vertices.
HoleFill fan_about_centroid(const Mesh& mesh, std::span<const VertexId> rim) {
  HoleFill lid;
  Vector3d centroid = Vector3d::Zero();
  // Divide before adding, to avoid overflow.
  for (const VertexId v : rim) centroid += mesh.vertices[v] / static_cast<double>(rim.size());
  lid.centroid = centroid;
  for (std::size_t i = 0; i < rim.size(); ++i)
    lid.triangles.push_back({rim[i], rim[(i + 1) % rim.size()], kCentroid});
  return lid;
}

/// Merges a polygon and coplanar holes in it (of opposite orientation) into one polygon with a bridge to each
/// hole and back. Returns nullopt if a hole has no bridge that intersects no edge.
std::optional<std::vector<VertexId>> bridge_holes(const Mesh& mesh, std::vector<VertexId> rim,
                                                  std::vector<std::vector<VertexId>> holes,
                                                  const HoleProjection& view) {
  while (!holes.empty()) {
    const std::optional<Bridge> bridge = find_bridge(mesh, rim, holes, view);
    if (!bridge) return std::nullopt;
    const std::vector<VertexId>& hole = holes[bridge->hole];
    const auto from = static_cast<std::ptrdiff_t>(bridge->from);
    // Follow the polygon to the bridge, around the hole back to the bridge's end, and on: both ends occur
    // twice.
    std::vector<VertexId> joined(rim.begin(), rim.begin() + from + 1);
    for (std::size_t i = 0; i <= hole.size(); ++i) joined.push_back(hole[(bridge->to + i) % hole.size()]);
    joined.insert(joined.end(), rim.begin() + from, rim.end());
    rim = std::move(joined);
    holes.erase(holes.begin() + static_cast<std::ptrdiff_t>(bridge->hole));
  }
  return rim;
}

/// Returns true if a point is strictly inside a simple polygon. Exact.
bool lies_inside(const Mesh& mesh, std::span<const VertexId> rim, VertexId point,
                 const HoleProjection& view) {
  // Crossing parity along the ray towards +x. Edges count as half-open in y, so that a vertex at the ray's
  // height counts once.
  bool inside = false;
  const auto& x = mesh.vertices;
  const double height = x[point][view.y];
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const VertexId a = rim[i], b = rim[(i + 1) % rim.size()];
    const bool a_above = x[a][view.y] > height, b_above = x[b][view.y] > height;
    const int side = turn(mesh, view, a, b, point);
    // On the edge: on its line and within its bounding box.
    if (side == 0 && std::min(x[a][view.x], x[b][view.x]) <= x[point][view.x] &&
        x[point][view.x] <= std::max(x[a][view.x], x[b][view.x]) &&
        std::min(x[a][view.y], x[b][view.y]) <= height && height <= std::max(x[a][view.y], x[b][view.y]))
      return false;
    // An upward edge passes right of the point if the point is on its left, and vice versa.
    if (a_above != b_above && (side > 0) == b_above) inside = !inside;
  }
  return inside;
}

// The fills.

using Edge = std::array<VertexId, 2>;
using Edges = std::set<Edge>;

Edge edge_of(VertexId v, VertexId w) {
  return {std::min(v, w), std::max(v, w)};
}

/// A fill in progress: the holes that it fills, its candidates, and the current one.
struct Attempt {
  std::vector<std::size_t> holes;  ///< the first one encloses the others
  std::vector<std::optional<HoleFill>> ways;
  std::size_t way = 0;
  const HoleFill& lid() const { return *ways[way]; }
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
        while (a.way < a.ways.size() && !(a.ways[a.way] && edges_are_free(a.lid()))) ++a.way;
      std::erase_if(attempts, [](const Attempt& a) { return a.way == a.ways.size(); });
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
      attempts[i].way = accepted[i] ? attempts[i].ways.size() : attempts[i].way + 1;
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
