/// Distance from a point to a surface by an AABB tree: split at medians, traversed depth-first with the
/// nearer child first. Distances of boxes prune; triangles give proven lower bounds of their distance.

#include "engine/query/clash/surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "engine/core/clash_tolerances.hpp"
#include "engine/core/infinity.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"

namespace lrb::parting {
namespace {

/// Triangles in a leaf.
constexpr std::uint32_t kLeafTriangles = 4;
/// Covers a few roundings in the distance of a box.
constexpr double kBoxRounding = 1 - 0x1p-48;

}  // namespace

SurfaceDistance::SurfaceDistance(const UnitBody& body) : body_(body), order_(body.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vector3d> middles;
  middles.reserve(order_.size());
  // Three times the centroids: good enough to compare.
  for (const auto& t : body.triangles)
    middles.push_back(body.points[t[0]] + body.points[t[1]] + body.points[t[2]]);
  nodes_.reserve(order_.size());
  build(0, static_cast<std::uint32_t>(order_.size()), middles);
}

std::uint32_t SurfaceDistance::build(std::uint32_t begin, std::uint32_t end,
                                     const std::vector<Vector3d>& middles) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({Eigen::AlignedBox3d(), begin, end});
  // Box of the triangles, and box of the centroids.
  Eigen::AlignedBox3d of_middles;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const std::uint32_t v : body_.triangles[order_[i]]) nodes_[index].box.extend(body_.points[v]);
    of_middles.extend(middles[order_[i]]);
  }
  if (end - begin <= kLeafTriangles) return index;
  // Median split along the longest axis of the centroids: the depth is about log2 of the number of triangles.
  Eigen::Index axis = 0;
  of_middles.sizes().maxCoeff(&axis);
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) { return middles[i][axis] < middles[j][axis]; });
  const std::uint32_t left = build(begin, half, middles), right = build(half, end, middles);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

/// Along any direction n a triangle is at least as far as its nearest corner: the least n . (c - x) / |n|. In
/// the direction of the nearest point this is the distance, and if rounding spoils n, it still is a lower
/// bound.
double SurfaceDistance::bound(std::uint32_t triangle, const Vector3d& x) const {
  const auto& t = body_.triangles[triangle];
  // Seen from x, which becomes the origin.
  const Vector3d a = body_.points[t[0]] - x, b = body_.points[t[1]] - x, c = body_.points[t[2]] - x;
  const SimplexPoint p = nearest_on_triangle(Vector3d::Zero(), a, b, c);
  const Vector3d n = p.weight[0] * a + p.weight[1] * b + p.weight[2] * c;
  const double length = n.norm();
  // Slab bound: a plane through the origin, perpendicular to n, with the triangle in front of it.
  const double slab = length > 0 ? std::min({n.dot(a), n.dot(b), n.dot(c)}) / length : 0;
  return slab > kClearanceMargin ? slab - kClearanceMargin : 0;
}

double SurfaceDistance::at(const Vector3d& x) const {
  double least = kInfinity;
  struct Waiting {
    std::uint32_t node;
    double distance;
  };
  constexpr std::size_t kDeepest = 64;  // halves of fewer than 2^32 triangles: one waits for each
  std::array<Waiting, kDeepest> stack;
  std::size_t size = 1;
  stack[0] = {0, 0};
  const auto distance = [&](std::uint32_t i) {
    return std::sqrt(nodes_[i].box.squaredExteriorDistance(x)) * kBoxRounding;
  };
  // The nearer child is on top, so that `least` falls early.
  while (size > 0) {
    const Waiting top = stack[--size];
    // The box is not nearer than the best triangle.
    if (top.distance >= least) continue;
    const Node& node = nodes_[top.node];
    if (node.left == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) least = std::min(least, bound(order_[i], x));
      continue;
    }
    // The farther child waits below the nearer one.
    Waiting near{node.left, distance(node.left)}, far{node.right, distance(node.right)};
    if (far.distance < near.distance) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
  return least;
}

}  // namespace lrb::parting
