/// Copies the triangles of both bodies into a common frame, centred on the box of both and scaled by a power
/// of two so that coordinates are at most 1/2. Scaling is exact, so each coordinate is rounded once, by the
/// subtraction.

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "engine/clash/clash_parts.hpp"
#include "engine/clash/clash_tolerances.hpp"
#include "engine/collide/interiors.hpp"
#include "engine/core/geometry.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"

namespace lrb::penetration {

// Distance from a point to a surface by an AABB tree with median splits, traversed depth-first with the
// nearer child first. Distances of boxes prune; triangles yield proven lower bounds of their distance.

namespace {

/// Maximum number of triangles in a leaf.
constexpr std::uint32_t kLeafTriangles = 4;
/// Covers the roundings in the distance of a box.
constexpr double kBoxRounding = 1 - 0x1p-48;

}  // namespace

SurfaceDistance::SurfaceDistance(const UnitBody& body) : body_(body), order_(body.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vector3d> centroids;
  centroids.reserve(order_.size());
  // Three times the centroids, which suffices for comparison.
  for (const auto& t : body.triangles)
    centroids.push_back(body.points[t[0]] + body.points[t[1]] + body.points[t[2]]);
  nodes_.reserve(order_.size());
  build(0, static_cast<std::uint32_t>(order_.size()), centroids);
}

std::uint32_t SurfaceDistance::build(std::uint32_t begin, std::uint32_t end,
                                     const std::vector<Vector3d>& centroids) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({Eigen::AlignedBox3d(), begin, end});
  // Box of the triangles, and box of the centroids.
  Eigen::AlignedBox3d box_of_centroids;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const std::uint32_t v : body_.triangles[order_[i]]) nodes_[index].box.extend(body_.points[v]);
    box_of_centroids.extend(centroids[order_[i]]);
  }
  if (end - begin <= kLeafTriangles) return index;
  // Median split along the longest axis of the centroids: the depth is about log2 of the number of triangles.
  Eigen::Index axis = 0;
  box_of_centroids.sizes().maxCoeff(&axis);
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) { return centroids[i][axis] < centroids[j][axis]; });
  const std::uint32_t left = build(begin, half, centroids), right = build(half, end, centroids);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

/// Along any direction n the triangle is at least as far away as its nearest corner: the least n . (c - x) /
/// |n|. In the direction of the nearest point this is the distance. If n is inaccurate, it is still a lower
/// bound.
double SurfaceDistance::bound(std::uint32_t triangle, const Vector3d& x) const {
  const auto& t = body_.triangles[triangle];
  // Relative to x, which becomes the origin.
  const Vector3d a = body_.points[t[0]] - x, b = body_.points[t[1]] - x, c = body_.points[t[2]] - x;
  const SimplexPoint p = nearest_on_triangle(Vector3d::Zero(), a, b, c);
  const Vector3d n = p.weight[0] * a + p.weight[1] * b + p.weight[2] * c;
  const double length = n.norm();
  // Slab bound: a plane through the origin, normal to n, with the triangle in front of it.
  const double slab = length > 0 ? std::min({n.dot(a), n.dot(b), n.dot(c)}) / length : 0;
  return slab > kClearanceMargin ? slab - kClearanceMargin : 0;
}

double SurfaceDistance::at(const Vector3d& x) const {
  double least = kInfinity;
  struct Waiting {
    std::uint32_t node;
    double distance;
  };
  constexpr std::size_t kDeepest = 64;  // depth of a tree of fewer than 2^32 triangles: one entry per level
  std::array<Waiting, kDeepest> stack;
  std::size_t size = 1;
  stack[0] = {0, 0};
  const auto distance = [&](std::uint32_t i) {
    return std::sqrt(nodes_[i].box.squaredExteriorDistance(x)) * kBoxRounding;
  };
  // The nearer child is on top, so that `least` decreases early.
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

namespace {

Vector3d as_vector(const double* x) {
  return {x[0], x[1], x[2]};
}

/// Copies the real triangles in world coordinates.
UnitBody copy_body(QueryBody& body) {
  UnitBody out;
  const LrbRep& rep = body.rep();
  // Compact numbers, in the order of first use.
  std::vector<VertexId> number(rep.vertices().size(), kNull);
  const bool mirrored = is_reflection(body.world.pose(), 3);
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      VertexId& known = number[v[k]];
      if (known == kNull) {
        known = VertexId(out.points.size());
        out.points.push_back(as_vector(body.world(v[k])));
      }
      triangle[k] = known.value();
    }
    // A reflection reverses triangles: restore the outward orientation.
    if (mirrored) std::swap(triangle[1], triangle[2]);
    out.triangles.push_back(triangle);
  }
  return out;
}

}  // namespace

Vector3d UnitFrame::to_unit(const Vector3d& world) const {
  Vector3d x = world - origin;
  for (int k = 0; k < 3; ++k) x[k] = std::ldexp(x[k], -exponent);
  return x;
}

Vector3d UnitFrame::to_world(const Vector3d& unit) const {
  Vector3d x;
  for (int k = 0; k < 3; ++k) x[k] = std::ldexp(unit[k], exponent) + origin[k];
  return x;
}

double UnitFrame::length_to_world(double x) const {
  return std::ldexp(x, exponent);
}

UnitBodies unit_bodies(QueryContext& context) {
  UnitBodies out;
  Eigen::AlignedBox3d box;
  for (int side = 0; side < 2; ++side) {
    out.body[side] = copy_body(context.body[side]);
    for (const Vector3d& x : out.body[side].points) box.extend(x);
  }
  // Halved first, because the sum or the difference could overflow.
  out.frame.origin = 0.5 * box.min() + 0.5 * box.max();
  const double reach = (0.5 * box.max() - 0.5 * box.min()).maxCoeff();
  // 2^(ilogb + 1) exceeds the half extent, so that coordinates stay below 1/2.
  out.frame.exponent = reach > 0 ? std::ilogb(reach) + 2 : 0;
  for (UnitBody& body : out.body)
    for (Vector3d& x : body.points) x = out.frame.to_unit(x);
  return out;
}

}  // namespace lrb::penetration
