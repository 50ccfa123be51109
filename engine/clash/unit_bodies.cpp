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

namespace lrb {

// Distance from a point to a surface by a tree traversed depth-first with the nearer child first. Distances
// of boxes prune; triangles yield proven lower bounds of their distance.

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

/// In the coordinates of the box, which is then a cube, the triangle is at least as far away as along any
/// normal: the least n . c over the sum of the |n_k|. One of 13 normals yields the distance: those of the
/// cube's faces and of the triangle, and the products of their edges. Not all are tried once `enough` is
/// reached.
double SurfaceDistance::bound(std::uint32_t triangle, const Vector3d& x, const BoxNorm& norm, double enough,
                              Vector3d& normal) const {
  const auto& t = body_.triangles[triangle];
  const Vector3d a = norm.shares * (body_.points[t[0]] - x), b = norm.shares * (body_.points[t[1]] - x),
                 c = norm.shares * (body_.points[t[2]] - x);
  // The cube's faces.
  int axis = 0;
  double best = a.cwiseMin(b).cwiseMin(c).cwiseMax(-a.cwiseMax(b).cwiseMax(c)).maxCoeff(&axis);
  normal = Vector3d::Unit(axis);
  // The triangle, by all corners: rounding may tilt the normal of a sliver.
  if (best < enough) {
    const Vector3d n = (b - a).cross(c - a);
    const double at_a = n.dot(a), at_b = n.dot(b), at_c = n.dot(c), size = n.cwiseAbs().sum();
    const double ahead = std::max(std::min({at_a, at_b, at_c}), -std::max({at_a, at_b, at_c}));
    if (ahead > best * size) {
      best = ahead / size;
      normal = n.cwiseAbs() / size;
    }
  }
  // Edges: n is normal to the edge and to axis k, and its product is the same at both ends.
  const Vector3d* const corners[5] = {&a, &b, &c, &a, &b};
  for (int edge = 0; edge < 3 && best < enough; ++edge) {
    const Vector3d &from = *corners[edge], &opposite = *corners[edge + 2], e = *corners[edge + 1] - from;
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double on = e[j] * from[i] - e[i] * from[j], off = e[j] * opposite[i] - e[i] * opposite[j];
      const double size = std::abs(e[i]) + std::abs(e[j]), ahead = std::min(std::abs(on), std::abs(off));
      if (!(on * off > 0) || !(ahead > best * size)) continue;
      best = ahead / size;
      normal.setZero();
      normal[i] = std::abs(e[j]) / size;
      normal[j] = std::abs(e[i]) / size;
    }
  }
  // Rounding of the corners counts most along the shortest half edge.
  return std::max(0.0, best - kClearanceMargin / norm.least_half);
}

double SurfaceDistance::at(const Vector3d& x, const BoxNorm& norm, double enough, Vector3d* normal) const {
  double least = kInfinity;
  const Eigen::Matrix3d sizes = norm.shares.cwiseAbs();
  struct Waiting {
    std::uint32_t node;
    double distance;
  };
  std::array<Waiting, BoxTree::kMaxDepth> stack;
  std::size_t size = 1;
  stack[0] = {0, 0};
  const auto nodes = tree_.nodes();
  // Along each axis of the norm: the distance of the centre, less half of the extent.
  const auto distance = [&](std::uint32_t i) {
    const Box& box = nodes[i].box;
    const Vector3d centre = 0.5 * (box.min() + box.max()) - x, half = 0.5 * (box.max() - box.min());
    return ((norm.shares * centre).cwiseAbs() - sizes * half).maxCoeff();
  };
  // The nearer child is on top, so that `least` decreases early.
  while (size > 0 && least > enough) {
    const Waiting top = stack[--size];
    // The box is not nearer than the best triangle.
    if (top.distance >= least) continue;
    const BoxTree::Node& node = nodes[top.node];
    if (node.right == 0) {
      for (std::uint32_t i = node.first; i < node.last; ++i) {
        Vector3d n;
        const double d = bound(tree_.items()[i], x, norm, least, n);
        if (!(d < least)) continue;
        least = d;
        if (normal != nullptr) *normal = n;
      }
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
