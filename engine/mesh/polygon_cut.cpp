// Triangles of a polygon that its fan does not cover, by ear clipping (Meisters 1975) with exact predicates,
// in the projection along the axis closest to the polygon's normal.
//
// Every ear has a positive area and a fold has none, so the triangles cover each point as often as the
// outline winds around it: the outline is the sum of their boundaries. Hence the result needs no proof that
// the outline is simple; only outlines with negative or several windings have no such triangles.
//
// An outline may touch itself: at a corner, or along an edge that it walks in both directions, such as the
// bridge to a hole. What touches an ear from outside does not block it. A corner on its boundary blocks it
// only if an edge runs from there into its interior.
//
// Only the neighbours of an ear that was cut off need new tests, so there are at most three for each corner.
// Each searches a tree of the remaining corners.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/box_tree.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Corner = std::uint32_t;
using Ear = std::array<Corner, 3>;

std::vector<BoxTree::Box> boxes_around(std::span<const Vector2d> points) {
  std::vector<BoxTree::Box> boxes;
  for (const Vector2d& p : points) boxes.emplace_back(Vector3d(p.x(), p.y(), 0));
  return boxes;
}

/// The remaining corners of a polygon in the plane.
class CornerTree {
 public:
  explicit CornerTree(std::span<const Vector2d> points)
      : tree_(boxes_around(points), 8), leaf_of_(tree_.leaves(points.size())) {
    for (const BoxTree::Node& node : tree_.nodes()) left_.push_back(node.last - node.first);
  }

  void remove(Corner corner) {
    for (std::uint32_t n = leaf_of_[corner]; n != kNull; n = tree_.nodes()[n].parent) --left_[n];
  }

  /// Returns true if test(corner) holds for a corner in a box for which is_near(box) holds. `steps` counts
  /// the nodes and corners visited. Tests corners that were removed, too, but no leaf without others.
  template <class Near, class Test>
  bool any(const Near& is_near, const Test& test, std::uint64_t& steps) const {
    std::uint32_t stack[BoxTree::kMaxDepth] = {0};
    for (int size = 1; size > 0;) {
      const std::uint32_t n = stack[--size];
      const BoxTree::Node& node = tree_.nodes()[n];
      ++steps;
      if (left_[n] == 0 || !is_near(node.box)) continue;
      if (node.right != 0) {
        stack[size++] = node.right;
        stack[size++] = n + 1;
        continue;
      }
      steps += node.last - node.first;
      for (Corner i = node.first; i < node.last; ++i)
        if (test(tree_.items()[i])) return true;
    }
    return false;
  }

 private:
  BoxTree tree_;
  std::vector<std::uint32_t> leaf_of_;
  std::vector<std::uint32_t> left_;  ///< (nodes) the corners that remain
};

class EarClipping {
 public:
  /// `points`: counter-clockwise.
  explicit EarClipping(std::span<const Vector2d> points)
      : points_(points), tree_(points), links_(points.size()), left_(points.size()) {
    const auto n = static_cast<Corner>(points.size());
    for (Corner i = 0; i < n; ++i) links_[i] = {(i + n - 1) % n, (i + 1) % n};
  }

  /// Appends the triangles. Returns false if there are none that cover the polygon, or if the search takes
  /// too long.
  bool run(std::vector<Ear>& ears) {
    const std::size_t first = ears.size();
    // A second round follows if ears remain that only touch the rest of the outline with their diagonals.
    for (const bool strict : {true, false}) {
      strict_ = strict;
      for (Corner i = 0; i < links_.size(); ++i)
        if (!links_[i].gone) changed_.push_back(i);
      cut_flat(ears);
      while (left_ > 3 && next_in_queue_ < queue_.size() && steps_ < most_steps()) {
        const auto [i, turn] = queue_[next_in_queue_++];
        if (links_[i].gone || links_[i].turn != turn || !is_ear(i)) continue;
        cut(i, ears);
        cut_flat(ears);
      }
      if (left_ == 3) break;
    }
    Corner i = 0;
    while (links_[i].gone) ++i;
    if (left_ == 3 && turn_at(i) >= 0) {
      ears.push_back({links_[i].before, i, links_[i].after});
      return true;
    }
    ears.resize(first);
    return false;
  }

 private:
  struct Link {
    Corner before, after;
    std::uint32_t turn = 0;  ///< number of the latest entry in the queue
    bool gone = false;
  };
  struct Entry {
    Corner corner;
    std::uint32_t turn;
  };

  /// The usual number is below 100 for each corner.
  std::uint64_t most_steps() const { return 1'000'000 + 1000 * std::uint64_t{links_.size()}; }

  int orient(Corner a, Corner b, Corner c) const {
    return exact::orient2d(points_[a].data(), points_[b].data(), points_[c].data());
  }
  int turn_at(Corner i) const { return orient(links_[i].before, i, links_[i].after); }
  bool same(Corner i, Corner j) const { return points_[i] == points_[j]; }

  /// Returns true if the outline turns back on itself at b, or b and a neighbour coincide.
  bool is_flat(Corner b) const {
    const Vector2d &p = points_[links_[b].before], &q = points_[b], &r = points_[links_[b].after];
    if (p == q || q == r) return true;
    if (turn_at(b) != 0) return false;
    const int axis = p.x() != q.x() ? 0 : 1;
    return (p[axis] < q[axis]) == (r[axis] < q[axis]);
  }

  bool is_ear(Corner b) const {
    const Corner a = links_[b].before, c = links_[b].after;
    return orient(a, b, c) > 0 && !is_blocked(a, b, c);
  }

  bool is_blocked(Corner a, Corner b, Corner c) const {
    BoxTree::Box box;
    for (const Corner i : {a, b, c}) box.extend(Vector3d(points_[i].x(), points_[i].y(), 0));
    const Corner from[3] = {a, b, c}, to[3] = {b, c, a};
    const auto is_near = [&](const BoxTree::Box& node) {
      // Inclusive, as touching corners count. Beyond a side: so is the node's corner that is furthest
      // inwards.
      if (!BoxTree::intersect(node, box)) return false;
      for (int k = 0; k < 3; ++k) {
        const Vector2d &p = points_[from[k]], &q = points_[to[k]];
        const Vector2d inmost(q.y() > p.y() ? node.min().x() : node.max().x(),
                              q.x() > p.x() ? node.max().y() : node.min().y());
        if (exact::orient2d(p.data(), q.data(), inmost.data()) < 0) return false;
      }
      return true;
    };
    const auto blocks = [&](Corner r) {
      if (links_[r].gone) return false;
      int side[3];
      for (int k = 0; k < 3; ++k)
        if ((side[k] = orient(from[k], to[k], r)) < 0) return false;
      if (strict_ && side[2] == 0 && !same(r, a) && !same(r, c)) return true;
      // An edge runs into the interior if its end is in front of all sides that r is on: of none if r is
      // inside.
      const auto enters = [&](Corner end) {
        for (int k = 0; k < 3; ++k)
          if (side[k] == 0 && orient(from[k], to[k], end) <= 0) return false;
        return true;
      };
      return enters(links_[r].before) || enters(links_[r].after);
    };
    return tree_.any(is_near, blocks, steps_);
  }

  void cut(Corner b, std::vector<Ear>& ears) {
    const Corner a = links_[b].before, c = links_[b].after;
    ears.push_back({a, b, c});
    links_[a].after = c;
    links_[c].before = a;
    links_[b].gone = true;
    tree_.remove(b);
    --left_;
    changed_.push_back(a);
    changed_.push_back(c);
  }

  /// Cuts off flat corners first, since past them an ear could be outside of the polygon. Puts the others
  /// that changed at the end of the queue: not one corner after another of the outline, which would give long
  /// ears.
  void cut_flat(std::vector<Ear>& ears) {
    for (std::size_t k = 0; k < changed_.size(); ++k) {
      const Corner i = changed_[k];
      if (links_[i].gone) continue;
      if (left_ > 3 && is_flat(i))
        cut(i, ears);
      else
        queue_.push_back({i, ++links_[i].turn});
    }
    changed_.clear();
  }

  std::span<const Vector2d> points_;
  CornerTree tree_;
  std::vector<Link> links_;
  std::vector<Entry> queue_;
  std::vector<Corner> changed_;
  std::size_t next_in_queue_ = 0, left_;
  mutable std::uint64_t steps_ = 0;
  bool strict_ = true;
};

/// Returns true if a corner's distance from the plane through the mean of the corners exceeds a tenth of the
/// largest distance from that mean.
bool is_far_from_planar(std::span<const Vector3d> corners, const Vector3d& normal, double size) {
  constexpr double kFar = 0.1;
  Vector3d mean(0, 0, 0);
  for (const Vector3d& x : corners) mean += x / size;
  mean /= static_cast<double>(corners.size());
  double height = 0, radius = 0;
  for (const Vector3d& x : corners) {
    const Vector3d d = x / size - mean;
    height = std::max(height, std::abs(dot3(d, normal)));
    radius = std::max(radius, norm3(d));
  }
  return !(height <= kFar * radius * norm3(normal));
}

}  // namespace

PolygonCut cut_polygon(std::span<const Vector3d> corners,
                       std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const FloatMode float_mode;
  const auto n = static_cast<Corner>(corners.size());
  triangles.clear();
  const auto fan = [&] {
    for (Corner i = 1; i + 1 < n; ++i) triangles.push_back({0, i, i + 1});
  };
  if (n <= 3) return fan(), PolygonCut::fan;
  const auto [normal, size] = newell_normal(n, [&](std::size_t i) -> const Vector3d& { return corners[i]; });
  // The axis closest to the normal. The next one if all turns vanish there, as those of a rounded normal of 0
  // may.
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(),
            [&along = normal](int i, int j) { return std::abs(along[i]) > std::abs(along[j]); });
  int axis = 0, x = 0, y = 0;
  bool left = false, right = false;
  for (std::size_t k = 0; k < 3 && !left && !right; ++k) {
    axis = axes[k], x = (axis + 1) % 3, y = (axis + 2) % 3;
    // The fan covers the polygon if no two of its triangles are opposed.
    for (Corner i = 1; i + 1 < n && !(left && right); ++i) {
      const int turn = exact::orient_axes(corners[0].data(), corners[i].data(), corners[i + 1].data(), x, y);
      left |= turn > 0;
      right |= turn < 0;
    }
  }
  if (!(left && right)) return fan(), PolygonCut::fan;
  if (is_far_from_planar(corners, normal, size)) return fan(), PolygonCut::folded;
  // A mirrored polygon is counter-clockwise if its coordinates are exchanged.
  const bool clockwise = normal[axis] < 0;
  std::vector<Vector2d> seen(n);
  for (Corner i = 0; i < n; ++i)
    seen[i] = clockwise ? Vector2d(corners[i][y], corners[i][x]) : Vector2d(corners[i][x], corners[i][y]);
  if (EarClipping(seen).run(triangles)) return PolygonCut::ears;
  return fan(), PolygonCut::folded;
}

PolygonCut cut_polygon(const Mesh& mesh, FaceId f, std::vector<std::array<VertexId, 3>>& triangles) {
  const auto corners = mesh.face(f);
  triangles.clear();
  if (corners.size() <= 3) {
    if (corners.size() == 3) triangles.push_back({corners[0], corners[1], corners[2]});
    return PolygonCut::fan;
  }
  std::vector<Vector3d> x;
  for (const VertexId v : corners) x.push_back(mesh.vertices[v]);
  std::vector<Ear> ears;
  const PolygonCut cut = cut_polygon(x, ears);
  for (const auto& [i, j, k] : ears) triangles.push_back({corners[i], corners[j], corners[k]});
  return cut;
}

}  // namespace lrb
