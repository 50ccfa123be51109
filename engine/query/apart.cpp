#include "engine/query/apart.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

Corners relative_to(const double* origin, const double* const x[3], int dim) {
  Corners c;
  for (int k = 0; k < 3; ++k) {
    const double* p = x[dim == 2 && k == 2 ? 1 : k];
    c[k] = {p[0] - origin[0], p[1] - origin[1], dim == 3 ? p[2] - origin[2] : 0};
  }
  return c;
}

/// Looks for the widest slab between two simplices. Any direction can be tried, however it came about; one
/// too short to be told from rounding proves nothing, nor does an overflow.
class SlabSearch {
 public:
  SlabSearch(int dim, const Corners& a, const Corners& b, double margin)
      : dim_(dim), a_(a), b_(b), margin_(margin) {}

  static constexpr int kLikely = 3;
  int directions() const { return dim_ == 3 ? 21 : 7; }

  /// Width of the slab across a direction; 0 if there is none wider than the margin.
  double width(int direction) const {
    const Vector3d d = dim_ == 3 ? in_space(direction) : in_plane(direction);
    const double length_sq = d.squaredNorm();
    if (!std::isnormal(length_sq)) return 0;
    const double length = std::sqrt(length_sq), least = margin_ * length;
    if (!std::isnormal(least)) return 0;
    const double a0 = d.dot(a_[0]), a1 = d.dot(a_[1]), a2 = d.dot(a_[2]);
    const double b0 = d.dot(b_[0]), b1 = d.dot(b_[1]), b2 = d.dot(b_[2]);
    const double w = std::max(std::min({b0, b1, b2}) - std::max({a0, a1, a2}),
                              std::min({a0, a1, a2}) - std::max({b0, b1, b2}));
    return w > least ? w / length : 0;
  }

 private:
  static Vector3d edge(const Corners& c, int k) { return c[(k + 1) % 3] - c[k]; }
  static Vector3d normal(const Corners& c) { return edge(c, 0).cross(edge(c, 1)); }
  Vector3d middles() const { return (b_[0] + b_[1] + b_[2]) - (a_[0] + a_[1] + a_[2]); }

  /// The line between the middles; normals; edge x edge; in the planes, across edges; the axes.
  Vector3d in_space(int i) const {
    if (i == 0) return middles();
    if (i < 3) return normal(i == 1 ? a_ : b_);
    if (i < 12) return edge(a_, (i - 3) / 3).cross(edge(b_, (i - 3) % 3));
    if (i < 15) return normal(a_).cross(edge(a_, i - 12));
    if (i < 18) return normal(b_).cross(edge(b_, i - 15));
    return Vector3d::Unit(i - 18);
  }
  Vector3d in_plane(int i) const {
    if (i == 0) return middles();
    if (i > 4) return Vector3d::Unit(i - 5);
    const Vector3d e = edge(i % 2 != 0 ? a_ : b_, 0);
    return i < 3 ? Vector3d(-e.y(), e.x(), 0) : e;
  }

  int dim_;
  const Corners &a_, &b_;
  double margin_;
};

/// Width of the slab across d between a range and a value, or two ranges; negative if they overlap.
double between(double low, double high, double other_low, double other_high) {
  return std::max(other_low - high, low - other_high);
}

/// The least of: the slabs between an edge's ends and a triangle, which must lie on opposite sides of it, and
/// those between that edge and the triangle's edges, which it must pass all on the same hand. Slabs, because
/// they are right for any direction, however badly rounded. 0 if the edge does not pass through, beyond
/// doubt.
double piercing_depth(const Corners& t, const Vector3d& p, const Vector3d& p2) {
  const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double size = n.norm();
  if (!std::isnormal(size)) return 0;
  const double t0 = n.dot(t[0]), t1 = n.dot(t[1]), t2 = n.dot(t[2]), h = n.dot(p), h2 = n.dot(p2);
  const double low = std::min({t0, t1, t2}), high = std::max({t0, t1, t2});
  if ((h > high) == (h2 > high)) return 0;
  double depth = std::min(between(low, high, h, h), between(low, high, h2, h2)) / size;
  const Vector3d along = p2 - p;
  int turns = 0;
  for (int side = 0; side < 3 && depth > 0; ++side) {
    const Vector3d &q = t[side], &r = t[(side + 1) % 3];
    const Vector3d across = (r - q).cross(along);
    const double length = across.norm(), volume = across.dot(q - p);
    const double doubt = kWrapperMargin * (r - q).norm() * along.norm() * (q - p).norm();
    if (!std::isnormal(length) || !(std::abs(volume) > doubt)) return 0;
    turns += volume > 0 ? 1 : -1;
    const double pa = across.dot(p), pb = across.dot(p2), qa = across.dot(q), qb = across.dot(r);
    depth = std::min(
        depth, between(std::min(pa, pb), std::max(pa, pb), std::min(qa, qb), std::max(qa, qb)) / length);
  }
  return std::abs(turns) == 3 ? std::max(depth, 0.0) : 0;
}

/// The least height of a triangle: what keeps it from becoming a segment.
double least_height(const Corners& t) {
  const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
  return longest > 0 ? (t[1] - t[0]).cross(t[2] - t[0]).norm() / longest : 0;
}

}  // namespace

double gap_between(double margin, double enough, int dim, const double* const a[3], const double* const b[3],
                   std::uint8_t& hint) {
  const Corners x = relative_to(a[0], a, dim), y = relative_to(a[0], b, dim);
  const SlabSearch search(dim, x, y, margin);
  double widest = search.width(hint);
  for (int i = 0, tried = hint; i < search.directions() && !(widest > enough); ++i) {
    if (i == tried) continue;
    const double width = search.width(i);
    if (!(width > widest)) continue;
    widest = width;
    hint = static_cast<std::uint8_t>(i);
  }
  return widest;
}

double likely_gap(double margin, double enough, int dim, const double* const a[3], const double* const b[3]) {
  const Corners x = relative_to(a[0], a, dim), y = relative_to(a[0], b, dim);
  const SlabSearch search(dim, x, y, margin);
  double widest = 0;
  for (int i = 0; i < SlabSearch::kLikely && !(widest > enough); ++i)
    widest = std::max(widest, search.width(i));
  return widest;
}

bool apart_by(double margin, int dim, const double* const a[3], const double* const b[3]) {
  std::uint8_t hint = 0;
  return gap_between(margin, margin, dim, a, b, hint) > margin;
}

double crossing_depth(double enough, const double* const a[3], const double* const b[3], std::uint8_t& hint) {
  const Corners x = relative_to(a[0], a, 3), y = relative_to(a[0], b, 3);
  const auto depth_of = [&](int i) {
    const Corners& edges = i < 3 ? y : x;
    return piercing_depth(i < 3 ? x : y, edges[i % 3], edges[(i + 1) % 3]);
  };
  double deepest = depth_of(hint);
  for (int i = 0, tried = hint; i < 6 && !(deepest > enough); ++i) {
    if (i == tried) continue;
    const double depth = depth_of(i);
    if (!(depth > deepest)) continue;
    deepest = depth;
    hint = static_cast<std::uint8_t>(i);
  }
  // Triangles that rounding could flatten do not cross.
  return std::min({deepest, least_height(x) / 4, least_height(y) / 4});
}

}  // namespace lrb
