#include "engine/mesh/hole_fill.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb {
namespace {

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

}  // namespace

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

std::optional<HoleFill> cut_corners(const Mesh& mesh, std::span<const VertexId> rim,
                                    const HoleProjection& view, const EdgeAllowed& allowed) {
  return CornerCutter(mesh, rim, view, allowed).run();
}

constexpr std::size_t kMaxForLeastArea = 256;  ///< the time is cubic
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

}  // namespace lrb
