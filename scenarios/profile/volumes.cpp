#include "scenarios/profile/volumes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "engine/core/geometry.hpp"
#include <lrbscope/core/polygon.hpp>
#include <lrbscope/error.hpp>

namespace lrb::profile {
namespace {

using capture::VolumeKind;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using trace::ShapeBox;

Vector3d point_at(std::span<const double> numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// Returns unit vectors along orthogonal vectors. Zero vectors get directions orthogonal to the others.
std::array<Vector3d, 3> directions_of(const std::array<Vector3d, 3>& along) {
  std::array<Vector3d, 3> out;
  std::array<bool, 3> known{};
  for (std::size_t k = 0; k < 3; ++k) {
    known[k] = !along[k].isZero(0);
    out[k] = known[k] ? along[k].stableNormalized() : Vector3d::Zero();
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (known[k]) continue;
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    if (known[i] && known[j])
      out[k] = out[i].cross(out[j]).normalized();
    else if (known[i] || known[j])
      out[k] = out[known[i] ? i : j].unitOrthogonal();
    else
      out[k] = Vector3d::Unit(static_cast<Eigen::Index>(k));
    known[k] = true;
  }
  return out;
}

ShapeBox aabb(const Vector3d& low, const Vector3d& high) {
  const Vector3d half = (high - low).cwiseMax(0) / 2;
  return {low + (high - low) / 2,
          {half.x() * Vector3d::UnitX(), half.y() * Vector3d::UnitY(), half.z() * Vector3d::UnitZ()}};
}

double outside_box(const ShapeBox& box, const Vector3d& p) {
  const std::array<Vector3d, 3> axes = directions_of(box.half);
  const Vector3d d = p - box.centre;
  Vector3d excess;
  for (int k = 0; k < 3; ++k)
    excess[k] = std::max(0.0, std::abs(d.dot(axes[static_cast<std::size_t>(k)])) -
                                  box.half[static_cast<std::size_t>(k)].norm());
  return excess.norm();
}

std::vector<Vector3d> corners_of(const ShapeBox& box) {
  std::vector<Vector3d> out;
  for (unsigned i = 0; i < 8; ++i)
    out.push_back(box.centre + (i & 1 ? 1 : -1) * box.half[0] + (i & 2 ? 1 : -1) * box.half[1] +
                  (i & 4 ? 1 : -1) * box.half[2]);
  return out;
}

/// A volume as the points within a radius of a box: of a sphere a box without extent, of an RSS one without
/// thickness, of an AABB or OBB itself.
struct RoundedBox {
  ShapeBox core;
  double radius = 0;

  double outside(const Vector3d& p) const { return std::max(0.0, outside_box(core, p) - radius); }
};

bool is_round(VolumeKind kind) {
  return kind == VolumeKind::sphere || kind == VolumeKind::rss;
}

/// Returns the volume of a node of a tree without k-DOPs.
RoundedBox rounded(const capture::Tree& tree, std::uint32_t node) {
  const auto n = tree.volume_of(node);
  const Vector3d none = Vector3d::Zero();
  switch (tree.volume) {
    case VolumeKind::sphere:
      return {{point_at(n, 0), {none, none, none}}, n[3]};
    case VolumeKind::rss: {
      const Vector3d u = point_at(n, 3) / 2, v = point_at(n, 6) / 2;
      return {{point_at(n, 0) + u + v, {u, v, none}}, n[9]};
    }
    case VolumeKind::obb:
      return {{point_at(n, 0), {point_at(n, 3), point_at(n, 6), point_at(n, 9)}}};
    default:
      return {aabb(point_at(n, 0), point_at(n, 3))};
  }
}

/// Returns true if a volume has greatest below least coordinates, or a negative radius.
bool inverted(const capture::Tree& tree, std::uint32_t node) {
  const auto n = tree.volume_of(node);
  switch (tree.volume) {
    case VolumeKind::aabb:
      return n[0] > n[3] || n[1] > n[4] || n[2] > n[5];
    case VolumeKind::sphere:
    case VolumeKind::rss:
      return n.back() < 0;
    case VolumeKind::obb:
      return false;
    case VolumeKind::kdop:
      break;
  }
  for (std::size_t k = 0; k < tree.directions.size(); ++k)
    if (n[2 * k] > n[2 * k + 1]) return true;
  return false;
}

/// Clips a polygon; `room` is memory to reuse.
void clip_in(std::vector<Vector3d>& polygon, const HalfSpace& half, std::vector<Vector3d>& room) {
  const auto above = [&](const Vector3d& p) { return half.normal.dot(p) - half.offset; };
  const auto is_inside = [&](const Vector3d& p) { return above(p) <= 0; };
  if (std::all_of(polygon.begin(), polygon.end(), is_inside)) return;
  room.clear();
  clip_polygon(
      polygon, [&](const Vector3d& p) { return -above(p); },
      [&](const Vector3d& x, std::size_t, bool, bool) { room.push_back(x); });
  polygon.swap(room);
}

/// Returns the solid in the given half-spaces, which lies in a ball.
Polytope solid(std::span<const HalfSpace> all, const Vector3d& centre, double radius) {
  constexpr double kRounding = 1e-13;        // relative
  constexpr double kSameNormal = 1 - 1e-14;  // cosine
  // Rounding errors must not remove the sides of flat solids: the other planes are moved by this much.
  const double slack = kRounding * std::max(radius, centre.norm());
  Polytope out;
  std::vector<Vector3d> face, room;
  // Each face is a square in its plane, larger than the ball, clipped to the other half-spaces.
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [normal, offset] = all[i];
    bool is_covered = false;  // by a parallel plane that is tighter, or equal and earlier
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (j == i || all[j].normal.dot(normal) < kSameNormal) continue;
      is_covered = is_covered || all[j].offset < offset - slack || (all[j].offset <= offset + slack && j < i);
    }
    if (is_covered) continue;
    const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
    const Vector3d at = centre + (offset - normal.dot(centre)) * normal;
    const double far = 2 * radius + slack;
    face = {at - far * u - far * v, at + far * u - far * v, at + far * u + far * v, at - far * u + far * v};
    for (std::size_t j = 0; j < all.size() && !face.empty(); ++j)
      if (j != i && all[j].normal.dot(normal) < kSameNormal)
        clip_in(face, {all[j].normal, all[j].offset + slack}, room);
    if (face.empty()) continue;
    const double area = area_of(face);
    out.area += area;
    out.volume += area * (offset - normal.dot(centre)) / 3;  // of the pyramid to the centre
    out.corners.insert(out.corners.end(), face.begin(), face.end());
  }
  out.volume = std::max(0.0, out.volume);
  return out;
}

ShapeBox placed(const ShapeBox& box, const Pose& pose) {
  return {pose.apply(box.centre), {pose.r * box.half[0], pose.r * box.half[1], pose.r * box.half[2]}};
}

/// Returns true if no axis of Gottschalk, Lin and Manocha 1996 separates the boxes: the three of each, and
/// the products of one from each.
bool boxes_overlap(const ShapeBox& a, const ShapeBox& b) {
  constexpr double kParallel = 1e-12;  // squared sine of the angle; such a product is covered by the others
  const Vector3d d = b.centre - a.centre;
  const auto separates = [&](const Vector3d& axis) {
    double reach = 0;
    for (std::size_t k = 0; k < 3; ++k)
      reach += std::abs(axis.dot(a.half[k])) + std::abs(axis.dot(b.half[k]));
    return std::abs(axis.dot(d)) > reach;
  };
  const std::array<Vector3d, 3> of_a = directions_of(a.half), of_b = directions_of(b.half);
  for (std::size_t k = 0; k < 3; ++k)
    if (separates(of_a[k]) || separates(of_b[k])) return false;
  for (const Vector3d& u : of_a)
    for (const Vector3d& v : of_b)
      if (const Vector3d axis = u.cross(v); axis.squaredNorm() > kParallel && separates(axis)) return false;
  return true;
}

}  // namespace

void clip(std::vector<Vector3d>& polygon, const HalfSpace& half) {
  std::vector<Vector3d> room;
  clip_in(polygon, half, room);
}

double area_of(const std::vector<Vector3d>& polygon) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  return sum.norm() / 2;
}

Volumes::Volumes(const capture::Tree& tree) : tree_(&tree), from_products_(Matrix3d::Identity()) {
  if (tree.volume != VolumeKind::kdop) return;
  constexpr double kFlat = 1e-6;  // least volume of the parallelepiped of three unit directions
  // Each direction is chosen to be as independent of those before as possible.
  const std::vector<Vector3d>& d = tree.directions;
  std::array<double, 3> best{};
  const auto choose = [&](std::size_t which, const auto& independence) {
    for (std::size_t k = 0; k < d.size(); ++k) {
      if (d[k].isZero(0)) continue;
      const double value = independence(d[k].normalized());
      if (value > best[which]) best[which] = value, spanning_[which] = k;
    }
    return d.empty() ? Vector3d::Zero().eval() : d[spanning_[which]].normalized();
  };
  const Vector3d u = choose(0, [](const Vector3d&) { return 1.0; });
  const Vector3d v = choose(1, [&](const Vector3d& w) { return u.cross(w).norm(); });
  choose(2, [&](const Vector3d& w) { return std::abs(u.cross(v).dot(w)); });
  if (best[2] < kFlat)
    throw InputError("tree " + std::to_string(tree.id) +
                     ": expected directions of its k-DOPs that span space, found " +
                     std::to_string(d.size()) + " in one plane; report at least three independent ones");
  Matrix3d rows;
  for (int i = 0; i < 3; ++i) rows.row(i) = d[spanning_[static_cast<std::size_t>(i)]];
  from_products_ = rows.inverse();
}

double Volumes::outside(std::uint32_t node, const Vector3d& p) const {
  const auto n = tree_->volume_of(node);
  if (tree_->volume == VolumeKind::aabb)
    return (point_at(n, 0) - p).cwiseMax(p - point_at(n, 3)).cwiseMax(0).norm();
  if (tree_->volume != VolumeKind::kdop) return rounded(*tree_, node).outside(p);
  double most = 0;
  for (std::size_t k = 0; k < tree_->directions.size(); ++k) {
    const Vector3d& d = tree_->directions[k];
    const double along = d.dot(p), excess = std::max(n[2 * k] - along, along - n[2 * k + 1]);
    if (excess > 0 && !d.isZero(0)) most = std::max(most, excess / d.norm());
  }
  return most;
}

double Volumes::excess(std::uint32_t node, std::uint32_t beyond) const {
  if (is_round(tree_->volume)) {
    // The distance to a box is convex, so a corner is farthest. From there the radius leads further out.
    const RoundedBox x = rounded(*tree_, node), other = rounded(*tree_, beyond);
    double farthest = 0;
    for (const Vector3d& p : corners_of(x.core)) farthest = std::max(farthest, outside_box(other.core, p));
    return std::max(0.0, farthest + x.radius - other.radius);
  }
  const auto n = tree_->volume_of(node), m = tree_->volume_of(beyond);
  if (tree_->volume == VolumeKind::aabb)
    return (point_at(m, 0) - point_at(n, 0)).cwiseMax(point_at(n, 3) - point_at(m, 3)).cwiseMax(0).norm();
  double most = 0;
  if (tree_->volume == VolumeKind::kdop) {
    bool is_inside = true;  // most are nested in every direction
    for (std::size_t k = 0; k < n.size(); k += 2)
      is_inside = is_inside && m[k] <= n[k] && n[k + 1] <= m[k + 1];
    if (is_inside) return 0;
  }
  for (const Vector3d& p : corners(node)) most = std::max(most, outside(beyond, p));
  return most;
}

VolumeSize Volumes::size(std::uint32_t node) const {
  if (tree_->volume == VolumeKind::kdop) {
    const Polytope solid = polytope(node);
    return {solid.area, solid.volume, solid.corners.empty()};
  }
  if (inverted(*tree_, node)) return {0, 0, true};
  // Steiner's formula: the sides, quarters of cylinders along the edges, and a sphere at the corners.
  constexpr double kPi = std::numbers::pi;
  const RoundedBox x = rounded(*tree_, node);
  const double a = 2 * x.core.half[0].norm(), b = 2 * x.core.half[1].norm(), c = 2 * x.core.half[2].norm(),
               r = x.radius, sides = 2 * (a * b + b * c + c * a), edges = kPi * (a + b + c);
  return {sides + 2 * edges * r + 4 * kPi * r * r,
          a * b * c + sides * r + edges * r * r + 4 * kPi / 3 * r * r * r};
}

ShapeBox Volumes::box(std::uint32_t node) const {
  if (tree_->volume != VolumeKind::kdop) {
    RoundedBox x = rounded(*tree_, node);
    if (!is_round(tree_->volume)) return x.core;
    const std::array<Vector3d, 3> axes = directions_of(x.core.half);
    for (std::size_t k = 0; k < 3; ++k) x.core.half[k] += std::max(0.0, x.radius) * axes[k];
    return x.core;
  }
  constexpr double kOrthogonal = 1e-9;
  const Matrix3d gram = from_products_.transpose() * from_products_;
  if (Matrix3d(gram.diagonal().asDiagonal()).isApprox(gram, kOrthogonal)) {
    Vector3d centre, reach;
    products(node, centre, reach);
    ShapeBox out{from_products_ * centre, {}};
    for (int i = 0; i < 3; ++i)
      out.half[static_cast<std::size_t>(i)] = std::max(0.0, reach[i]) * from_products_.col(i);
    return out;
  }
  const std::vector<Vector3d> all = polytope(node).corners;
  if (all.empty()) return aabb(Vector3d::Zero(), Vector3d::Zero());
  Vector3d low = all[0], high = all[0];
  for (const Vector3d& p : all) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return aabb(low, high);
}

void Volumes::products(std::uint32_t node, Vector3d& centre, Vector3d& reach) const {
  const auto n = tree_->volume_of(node);
  for (int i = 0; i < 3; ++i) {
    const std::size_t k = 2 * spanning_[static_cast<std::size_t>(i)];
    reach[i] = (n[k + 1] - n[k]) / 2;
    centre[i] = n[k] + reach[i];
  }
}

std::vector<Vector3d> Volumes::corners(std::uint32_t node) const {
  return tree_->volume == VolumeKind::kdop ? polytope(node).corners : corners_of(box(node));
}

std::vector<HalfSpace> Volumes::half_spaces(std::uint32_t node) const {
  std::vector<HalfSpace> out;
  const auto between = [&](const Vector3d& along, double least, double greatest) {
    out.push_back({along, greatest});
    out.push_back({-along, -least});
  };
  const auto n = tree_->volume_of(node);
  switch (tree_->volume) {
    case VolumeKind::aabb:
      for (int k = 0; k < 3; ++k)
        between(Vector3d::Unit(k), n[static_cast<std::size_t>(k)], n[static_cast<std::size_t>(k) + 3]);
      break;
    case VolumeKind::obb: {
      const ShapeBox b = box(node);
      const std::array<Vector3d, 3> axes = directions_of(b.half);
      for (std::size_t k = 0; k < 3; ++k) {
        const double centre = axes[k].dot(b.centre), half = b.half[k].norm();
        between(axes[k], centre - half, centre + half);
      }
      break;
    }
    case VolumeKind::kdop:
      for (std::size_t k = 0; k < tree_->directions.size(); ++k) {
        const Vector3d& d = tree_->directions[k];
        const double length = d.norm();
        if (length > 0) between(d / length, n[2 * k] / length, n[2 * k + 1] / length);
      }
      break;
    case VolumeKind::sphere:
    case VolumeKind::rss:
      break;
  }
  return out;
}

Polytope Volumes::polytope(std::uint32_t node) const {
  if (inverted(*tree_, node)) return {};
  // It lies in the parallelepiped of three directions.
  Vector3d centre, reach;
  products(node, centre, reach);
  double radius = 0;
  for (int i = 0; i < 3; ++i) radius += from_products_.col(i).norm() * reach[i];
  return solid(half_spaces(node), from_products_ * centre, radius);
}

std::optional<double> Volumes::shared_volume(std::uint32_t node, std::uint32_t other) const {
  if (inverted(*tree_, node) || inverted(*tree_, other)) return 0;
  const auto n = tree_->volume_of(node), m = tree_->volume_of(other);
  switch (tree_->volume) {
    case VolumeKind::aabb: {
      const Vector3d extent =
          point_at(n, 3).cwiseMin(point_at(m, 3)) - point_at(n, 0).cwiseMax(point_at(m, 0));
      return extent.cwiseMax(0).prod();
    }
    case VolumeKind::sphere: {
      const double r = std::max(n[3], m[3]), s = std::min(n[3], m[3]);
      const double d = (point_at(n, 0) - point_at(m, 0)).norm();
      if (d >= r + s) return 0;
      if (d <= r - s) return 4 * std::numbers::pi / 3 * s * s * s;
      // Two caps (Weisstein, "Sphere-Sphere Intersection").
      return std::numbers::pi * std::pow(r + s - d, 2) * (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) /
             (12 * d);
    }
    case VolumeKind::rss:
      return {};
    case VolumeKind::obb:
    case VolumeKind::kdop:
      break;
  }
  std::vector<HalfSpace> both = half_spaces(node);
  const std::vector<HalfSpace> of_other = half_spaces(other);
  both.insert(both.end(), of_other.begin(), of_other.end());
  const ShapeBox b = box(node);
  return solid(both, b.centre, b.half[0].norm() + b.half[1].norm() + b.half[2].norm()).volume;
}

namespace {

RoundedBox placed(RoundedBox x, const Pose& pose) {
  x.core = placed(x.core, pose);
  return x;
}

/// Returns the distance of two boxes, up to rounding.
double box_gap(const ShapeBox& a, const ShapeBox& b) {
  if (boxes_overlap(a, b)) return 0;
  // A point of each box is its centre plus its half edges times numbers in [-1, 1]. The squared distance is a
  // convex quadratic function of these six numbers. Minimise it along one of them after the other, and after
  // each round along all that are between their bounds together, as far as the bounds allow: the rounds alone
  // converge slowly if edges are nearly parallel.
  constexpr int kMaxRounds = 1000;
  constexpr double kConverged = 1e-13;
  std::array<Vector3d, 6> along;
  for (std::size_t k = 0; k < 3; ++k) along[k] = a.half[k], along[k + 3] = -b.half[k];
  std::array<double, 6> at{};
  Vector3d between = a.centre - b.centre;  // of the two points
  double last = between.norm();
  for (int round = 0; round < kMaxRounds; ++round) {
    for (std::size_t k = 0; k < along.size(); ++k) {
      const double length_sq = along[k].squaredNorm();
      if (!(length_sq > 0)) continue;
      const double best = std::clamp(at[k] - between.dot(along[k]) / length_sq, -1.0, 1.0);
      between += (best - at[k]) * along[k];
      at[k] = best;
    }
    Eigen::Matrix<double, 3, 6> free = Eigen::Matrix<double, 3, 6>::Zero();
    for (std::size_t k = 0; k < along.size(); ++k)
      if (std::abs(at[k]) < 1) free.col(static_cast<Eigen::Index>(k)) = along[k];
    // The shortest step of least squares, from the eigenvectors of the free edges' matrix of products.
    const Matrix3d products = free * free.transpose(), axes = eigenvectors_of_symmetric(products);
    const double most = products.diagonal().sum();
    Vector3d image = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Vector3d axis = axes.col(k);
      constexpr double kSingular = 1e-13;
      if (const double value = axis.dot(products * axis); value > kSingular * most)
        image -= axis.dot(between) / value * axis;
    }
    const Eigen::Matrix<double, 6, 1> step = free.transpose() * image;
    double share = 1;
    for (std::size_t k = 0; k < along.size(); ++k)
      if (const double d = step[static_cast<Eigen::Index>(k)]; std::abs(at[k]) < 1 && d != 0)
        share = std::min(share, ((d > 0 ? 1 : -1) - at[k]) / d);
    for (std::size_t k = 0; k < along.size(); ++k) {
      if (!(std::abs(at[k]) < 1)) continue;
      const double next = std::clamp(at[k] + share * step[static_cast<Eigen::Index>(k)], -1.0, 1.0);
      between += (next - at[k]) * along[k];
      at[k] = next;
    }
    const double now = between.norm();
    if (last - now <= kConverged * last) break;
    last = now;
  }
  return between.norm();
}

}  // namespace

bool overlap(const Volumes& a, std::uint32_t node_a, const Pose& pose_a, const Volumes& b,
             std::uint32_t node_b, const Pose& pose_b) {
  if (inverted(a.tree(), node_a) || inverted(b.tree(), node_b)) return false;
  if (is_round(a.tree().volume) && is_round(b.tree().volume))
    return gap(a, node_a, pose_a, b, node_b, pose_b) <= 0;
  return boxes_overlap(placed(a.box(node_a), pose_a), placed(b.box(node_b), pose_b));
}

double gap(const Volumes& a, std::uint32_t node_a, const Pose& pose_a, const Volumes& b, std::uint32_t node_b,
           const Pose& pose_b) {
  if (inverted(a.tree(), node_a) || inverted(b.tree(), node_b))
    return std::numeric_limits<double>::infinity();
  if (is_round(a.tree().volume) && is_round(b.tree().volume)) {
    const RoundedBox x = placed(rounded(a.tree(), node_a), pose_a),
                     y = placed(rounded(b.tree(), node_b), pose_b);
    return std::max(0.0, box_gap(x.core, y.core) - x.radius - y.radius);
  }
  return box_gap(placed(a.box(node_a), pose_a), placed(b.box(node_b), pose_b));
}

}  // namespace lrb::profile
