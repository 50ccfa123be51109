/// Copies the triangles of both bodies into a common frame, centred on the box of both and scaled by a power
/// of two so that coordinates are at most 1/2. Scaling is exact, so each coordinate is rounded once, by the
/// subtraction.

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/clash/clash_parts.hpp"
#include "engine/clash/clash_tolerances.hpp"
#include "engine/collide/interiors.hpp"
#include "engine/core/geometry.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"

namespace lrb {

// Distance from a point to a surface by a tree traversed depth-first with the nearer child first. Distances
// of boxes prune; triangles yield proven lower bounds of their distance.

namespace {

/// Covers the roundings in the distance of a box.
constexpr double kBoxRounding = 1 - 0x1p-48;

}  // namespace

SurfaceDistance::SurfaceDistance(const UnitBody& body) : body_(body) {
  // Halved by the centroids. Three times these suffice for comparison.
  std::vector<Eigen::AlignedBox3d> centroids;
  centroids.reserve(body.triangles.size());
  for (const auto& t : body.triangles)
    centroids.emplace_back(Vector3d(body.points[t[0]] + body.points[t[1]] + body.points[t[2]]));
  tree_ = BoxTree(centroids);
  tree_.fit([&](std::uint32_t i) {
    const auto& [a, b, c] = body.triangles[i];
    return Eigen::AlignedBox3d(body.points[a]).extend(body.points[b]).extend(body.points[c]);
  });
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

double SurfaceDistance::at(const Vector3d& x, double enough) const {
  double least = kInfinity;
  struct Waiting {
    std::uint32_t node;
    double distance;
  };
  std::array<Waiting, BoxTree::kMaxDepth> stack;
  std::size_t size = 1;
  stack[0] = {0, 0};
  const auto nodes = tree_.nodes();
  const auto distance = [&](std::uint32_t i) {
    return std::sqrt(nodes[i].box.squaredExteriorDistance(x)) * kBoxRounding;
  };
  // The nearer child is on top, so that `least` decreases early.
  while (size > 0 && least > enough) {
    const Waiting top = stack[--size];
    // The box is not nearer than the best triangle.
    if (top.distance >= least) continue;
    const BoxTree::Node& node = nodes[top.node];
    if (node.right == 0) {
      for (std::uint32_t i = node.first; i < node.last; ++i)
        least = std::min(least, bound(tree_.items()[i], x));
      continue;
    }
    // The farther child waits below the nearer one.
    Waiting near{top.node + 1, distance(top.node + 1)}, far{node.right, distance(node.right)};
    if (far.distance < near.distance) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
  return least > enough ? least : 0;
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

}  // namespace lrb
