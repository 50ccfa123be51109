// Exact tests of a polygon's shape, and triangulations without degenerate triangles.
// 1. Convexity: project along an axis close to the normal. All turns must have the same sign, and the sides
//    must change twice between left-to-right and right-to-left, which excludes polygons that wind more than
//    once.
// 2. Triangulations: no triangle has all three corners on one straight side.
#include "engine/mesh/polygon_shape.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb {
namespace {

const double* point(const Mesh& mesh, VertexId v) {
  return mesh.vertices[v].data();
}

/// Returns the axes in order of decreasing component of the polygon's normal. Rounding only affects which
/// axis is tried first.
std::array<int, 3> axes_by_normal(const Mesh& mesh, std::span<const VertexId> corners) {
  const Eigen::Vector3d sum = newell_normal(corners.size(), [&](std::size_t i) -> const Eigen::Vector3d& {
                                return mesh.vertices[corners[i]];
                              }).first;
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int i, int j) { return std::abs(sum[i]) > std::abs(sum[j]); });
  return axes;
}

/// Returns the sign of the lexicographic order of two points in 2D.
int order(const double* a, const double* b) {
  for (int i = 0; i < 2; ++i)
    if (a[i] != b[i]) return a[i] < b[i] ? 1 : -1;
  return 0;
}

/// Returns the corners projected along `axis`; runs of equal ones once.
std::vector<Eigen::Vector2d> seen_along(int axis, const Mesh& mesh, std::span<const VertexId> corners) {
  std::vector<Eigen::Vector2d> seen;
  for (const VertexId v : corners) {
    const Eigen::Vector2d p(mesh.vertices[v][(axis + 1) % 3], mesh.vertices[v][(axis + 2) % 3]);
    if (seen.empty() || p != seen.back()) seen.push_back(p);
  }
  while (seen.size() > 1 && seen.front() == seen.back()) seen.pop_back();
  return seen;
}

/// Turns of a 2D polygon.
struct Round {
  bool left = false, right = false;  ///< there is a turn in that direction
  /// Number of changes in the lexicographic direction of its sides; 2 if it winds once.
  int changes = 0;

  bool has_turns() const { return left || right; }
  bool is_convex() const { return left != right && changes == 2; }
};

Round go_round(const std::vector<Eigen::Vector2d>& p) {
  Round round;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto &a = p[i], &b = p[(i + 1) % p.size()], &c = p[(i + 2) % p.size()];
    // Exact turn at b, and whether the lexicographic direction changes there.
    const int turn = exact::orient2d(a.data(), b.data(), c.data());
    round.left |= turn > 0;
    round.right |= turn < 0;
    round.changes += order(a.data(), b.data()) != order(b.data(), c.data());
  }
  return round;
}

bool is_straight(const Mesh& mesh, VertexId a, VertexId b, VertexId c) {
  return exact::collinear3d(point(mesh, a), point(mesh, b), point(mesh, c));
}

bool fan_has_area(const Mesh& mesh, std::span<const VertexId> corners) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    if (is_straight(mesh, corners[0], corners[i], corners[i + 1])) return false;
  return true;
}

/// The corners, rotated so that a proper one comes first, and the indices of the first and last of the other
/// proper ones. Corners inside a straight side are not proper. The ring is empty if fewer than three are
/// proper.
struct ProperRing {
  std::vector<VertexId> ring;
  std::size_t first = 0, last = 0;
};

ProperRing proper_ring(const Mesh& mesh, std::span<const VertexId> corners) {
  const std::size_t n = corners.size();
  // Proper corners are those where the polygon turns. An area requires three of them.
  std::vector<std::size_t> proper;
  for (std::size_t i = 0; i < n; ++i)
    if (!is_straight(mesh, corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n])) proper.push_back(i);
  if (proper.size() < 3) return {};
  // Rotate so that the first proper corner is corner 0; the other indices shift accordingly.
  ProperRing out{{corners.begin(), corners.end()}, proper[1] - proper[0], proper.back() - proper[0]};
  std::rotate(out.ring.begin(), out.ring.begin() + static_cast<std::ptrdiff_t>(proper[0]), out.ring.end());
  return out;
}

}  // namespace

double relative_height(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  const double longest = std::max({stable_norm3(y - x), stable_norm3(z - y), stable_norm3(x - z)});
  // Twice the area of a triangle with a longest edge of 1 is its height.
  return norm3(((y - x) / longest).cross((z - x) / longest));
}

std::optional<std::array<VertexId, 3>> spanning_corners(const Mesh& mesh, std::span<const VertexId> corners) {
  if (corners.size() < 3) return std::nullopt;
  const VertexId a = corners[0];
  // a, then the first corner at another position, then the first corner off the line through both.
  std::size_t i = 1;
  while (i < corners.size() && mesh.vertices[corners[i]] == mesh.vertices[a]) ++i;
  for (std::size_t k = i + 1; k < corners.size(); ++k)
    if (!is_straight(mesh, a, corners[i], corners[k])) return std::array{a, corners[i], corners[k]};
  return std::nullopt;
}

bool is_planar(const Mesh& mesh, std::span<const VertexId> corners, const std::array<VertexId, 3>& plane) {
  return std::all_of(corners.begin(), corners.end(), [&](VertexId v) {
    return exact::orient3d(point(mesh, plane[0]), point(mesh, plane[1]), point(mesh, plane[2]),
                           point(mesh, v)) == 0;
  });
}

bool is_convex(const Mesh& mesh, std::span<const VertexId> corners) {
  for (const int axis : axes_by_normal(mesh, corners)) {
    const Round round = go_round(seen_along(axis, mesh, corners));
    if (round.has_turns()) return round.is_convex();  // otherwise the polygon is seen edge-on
  }
  return false;
}

void triangulate_convex(const Mesh& mesh, std::span<const VertexId> corners,
                        std::vector<std::array<VertexId, 3>>& triangles) {
  triangles.clear();
  // The plain fan, if it has no degenerate triangle (nearly always).
  const ProperRing p =
      corners.size() == 3 || fan_has_area(mesh, corners) ? ProperRing{} : proper_ring(mesh, corners);
  if (p.ring.empty()) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      triangles.push_back({corners[0], corners[i], corners[i + 1]});
    return;
  }
  const auto add = [&](std::size_t i, std::size_t j, std::size_t k) {
    triangles.push_back({p.ring[i], p.ring[j], p.ring[k % p.ring.size()]});
  };
  // Corner 0 sees all sides except the two that contain it: those sides form a fan. The other two are seen
  // from the corner next to their far end. If that is the far end of the other one, the second is seen from
  // the first corner of the first.
  for (std::size_t i = p.first + 1; i + 1 < p.last; ++i) add(0, i, i + 1);
  const bool one_side_between = p.last == p.first + 1;
  for (std::size_t i = one_side_between ? 1 : 0; i < p.first; ++i) add(p.first + 1, i, i + 1);
  const std::size_t eye = one_side_between ? 1 : p.last - 1;
  for (std::size_t i = p.last; i < p.ring.size(); ++i) add(eye, i, i + 1);
}

void triangulate(const Mesh& mesh, FaceId f, std::vector<std::array<VertexId, 3>>& triangles) {
  const auto corners = mesh.face(f);
  if (corners.size() > 3) {
    const auto plane = spanning_corners(mesh, corners);
    // Planar and convex: a triangulation without degenerate triangles exists, and all triangulations have the
    // same shape.
    if (plane && is_planar(mesh, corners, *plane) && is_convex(mesh, corners))
      return triangulate_convex(mesh, corners, triangles);
  }
  cut_polygon(mesh, f, triangles);
}

namespace {

/// Chords through the interior of a polygon. Corners are numbered from a proper one; number n is corner 0
/// again.
class Chords {
 public:
  Chords(const Mesh& mesh, std::span<const VertexId> ring) : side_(ring.size(), 0) {
    for (std::size_t i = 1; i < ring.size(); ++i)
      // Consecutive corners on one straight side get the same number.
      side_[i] =
          side_[i - 1] + (is_straight(mesh, ring[i - 1], ring[i], ring[(i + 1) % ring.size()]) ? 0 : 1);
  }

  /// Returns a corner between i and j, as close to the median as possible, whose chords to i and to j are
  /// sides without inner corners or run through the interior. Requires that the chord from i to j is such a
  /// chord. Then there is one: beyond the end of the first side and before the start of the last one, or next
  /// to i, or next to j.
  std::size_t near_median(std::size_t i, std::size_t j) const {
    // Binary searches in the ascending numbers: the end of the side that starts at i, and the start of the
    // side that ends at j.
    const auto begin = side_.begin() + static_cast<std::ptrdiff_t>(i),
               end = side_.begin() + static_cast<std::ptrdiff_t>(j);
    const auto first_end = i + static_cast<std::size_t>(std::upper_bound(begin, end, *begin) - begin);
    const auto last_start = i + static_cast<std::size_t>(std::lower_bound(begin, end, *(end - 1)) - begin);
    // The median, moved past the ends of both sides if necessary.
    if (first_end + 1 < last_start) return std::clamp(i + (j - i) / 2, first_end + 1, last_start - 1);
    return i + 2 == j || side_[i + 1] != side_[j - 1] ? i + 1 : j - 1;
  }

 private:
  std::vector<std::uint32_t> side_;  ///< (|ring|) number of the straight side from the corner to the next
};

}  // namespace

void triangulate_by_halves(const Mesh& mesh, std::span<const VertexId> corners,
                           std::vector<std::array<VertexId, 3>>& triangles) {
  // Without proper corners use the fan.
  const ProperRing p = proper_ring(mesh, corners);
  const std::size_t n = p.ring.size();
  if (n == 0) return triangulate_convex(mesh, corners, triangles);
  triangles.clear();
  const Chords chords(mesh, p.ring);
  // The polygon is divided in two. Each part is divided by the triangle on its chord whose apex is the median
  // of its boundary. All triangles have area, because their corners are not on one side.
  const std::size_t half = chords.near_median(0, n);
  std::vector<std::array<std::size_t, 2>> todo = {{0, half}, {half, n}};
  while (!todo.empty()) {
    const auto [i, j] = todo.back();
    todo.pop_back();
    if (j == i + 1) continue;
    const std::size_t k = chords.near_median(i, j);
    triangles.push_back({p.ring[i], p.ring[k], p.ring[j % n]});
    todo.push_back({i, k});
    todo.push_back({k, j});
  }
}

}  // namespace lrb
