#pragma once
// Part of distance_kernel.inl, near_kernel.inl and pair_bounds_kernel.inl: the distances of pairs of
// triangles, one in each lane of a vector V of floats or doubles.

#include "engine/distance/kernel_doubles.inl"
#include "engine/tree/kernel_triangles.inl"

namespace lrb {
namespace {

// Both overloads take a double: Clang converts vectors of equal size, and would not choose otherwise.
inline Float8 splat_as(Float8, double x) {
  return splat(static_cast<float>(x));
}

template <class V>
inline V smaller(V x, V y) {
  return select(greater(x, y), y, x);
}

template <class V>
inline V dot(const V* x, const V* y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

template <class V>
inline void cross(const V* x, const V* y, V* product) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    product[i] = x[j] * y[k] - x[k] * y[j];
  }
}

/// Clamps x to [0, 1]; NaN becomes 0.
template <class V>
inline V clamp_share(V x) {
  return smaller(larger(x, V{}), splat_as(V{}, 1));
}

/// The edges of some triangles, with their squared lengths and the reciprocals of these.
template <class V>
struct EdgesOf {
  V along[3][3], square[3], per_square[3];

  explicit EdgesOf(const CornersOf<V>& t) {
    for (int i = 0; i < 3; ++i) {
      subtract(t.x[(i + 1) % 3], t.x[i], along[i]);
      // Infinite for an edge without length: the NaN that follows is clamped to 0.
      square[i] = dot(along[i], along[i]);
      per_square[i] = splat_as(V{}, 1) / square[i];
    }
  }
};

using Edges = EdgesOf<Float8>;

/// Two points on features of two triangles. Edge k runs from corner k to the next. A face has two parameters,
/// along the edges from its first corner to the others; the other triangle's point is then a corner.
template <class V>
struct FeaturePoints {
  V towards[3], square;  ///< from A to B, and its squared length
  int on[2];             ///< on A and B: the number of the edge or corner; kOnFace
  V share[2];            ///< on A's edge and on B's, or both on a face
};
constexpr int kOnFace = 3;

template <class V, class Keep>
inline void edge_to_edge(const CornersOf<V>& a, const EdgesOf<V>& of_a, int i, const CornersOf<V>& b,
                         const EdgesOf<V>& of_b, int j, Keep&& keep) {
  const V *u = of_a.along[i], *v = of_b.along[j];
  V between[3];
  FeaturePoints<V> p;
  // Closest points of two segments (Ericson 5.1.9, after Lumelsky 1985).
  subtract(b.x[j], a.x[i], between);
  const V uv = dot(u, v), uw = dot(u, between), vw = dot(v, between);
  // The denominator is |u|^2 |v|^2 sin^2 of the angle, which is about 0 for parallel edges: any clamped s
  // will do then.
  const V sine = of_a.square[i] * of_b.square[j] - uv * uv;
  V s = clamp_share((of_b.square[j] * uw - uv * vw) / sine);
  // Alternate projections: the closest point of the other segment, then of this one. Both stay on their
  // segments.
  const V t = clamp_share((uv * s - vw) * of_b.per_square[j]);
  s = clamp_share((uv * t + uw) * of_a.per_square[i]);
  for (int x = 0; x < 3; ++x) p.towards[x] = between[x] + t * v[x] - s * u[x];
  p.square = dot(p.towards, p.towards);
  p.on[0] = i, p.on[1] = j, p.share[0] = s, p.share[1] = t;
  keep(p);
}

/// Projects the corners of `points` on the faces of `t`. kFace: 0 if `t` is A's, otherwise 1.
template <int kFace, class V, class Keep>
inline void corners_to_face(const CornersOf<V>& t, const EdgesOf<V>& of, const CornersOf<V>& points,
                            Keep&& keep) {
  const V* u = of.along[0];
  V v[3];
  subtract(t.x[2], t.x[0], v);
  // Barycentric coordinates of the projection: normal equations in u and v, by Cramer's rule.
  const V uu = of.square[0], vv = of.square[2], uv = dot(u, v);
  const V per_area = splat_as(V{}, 1) / (uu * vv - uv * uv);
  for (int corner = 0; corner < 3; ++corner) {
    V w[3];
    FeaturePoints<V> p;
    subtract(points.x[corner], t.x[0], w);
    const V uw = dot(u, w), vw = dot(v, w);
    const V s = (vv * uw - uv * vw) * per_area, rest = (uu * vw - uv * uw) * per_area;
    // Outside the face an edge is closer, found by edge_to_edge(). A face without area yields NaN: not
    // inside.
    const auto inside = both(both(greater(s, V{}), greater(rest, V{})), greater(splat_as(V{}, 1), s + rest));
    for (int x = 0; x < 3; ++x) {
      const V d = w[x] - s * u[x] - rest * v[x];
      p.towards[x] = kFace == 0 ? d : -d;
    }
    p.square = select(inside, dot(p.towards, p.towards), splat_as(V{}, __builtin_inff()));
    p.on[kFace] = kOnFace, p.on[1 - kFace] = corner, p.share[0] = s, p.share[1] = rest;
    keep(p);
  }
}

/// Calls keep() with close points of two triangles, of which the closest are the closest points of the
/// triangles, if these are disjoint, up to rounding. The cases edge-edge and vertex-face are as in Ericson,
/// "Real-Time Collision Detection", 5.1. Whatever is rounded, the points are in their triangles, so each
/// length is at least the distance, up to the errors of the corners. Whether one is the minimum is not
/// guaranteed.
template <class V, class Keep>
inline void for_close_points(const CornersOf<V>& a, const EdgesOf<V>& of_a, const CornersOf<V>& b,
                             const EdgesOf<V>& of_b, Keep&& keep) {
  // Closest points of disjoint triangles lie on two edges, or on a vertex and a face: 9 + 6 cases.
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) edge_to_edge(a, of_a, i, b, of_b, j, keep);
  corners_to_face<0>(a, of_a, b, keep);
  corners_to_face<1>(b, of_b, a, keep);
}

/// Returns lower bounds on the distances of some pairs: the width of the slab between them along a direction
/// of any length. Any direction is valid, however it was found: only the errors of the difference of two
/// projections count, at most `error` |d|_1 + tiny. `down`: factor that covers the rounding of the root and
/// of the quotient. A direction of length 0 yields NaN, which proves nothing.
template <class V>
inline V slab(const V* direction, const CornersOf<V>& a, const CornersOf<V>& b, V error, V tiny, V down) {
  // Scale by the largest coordinate, so that neither products nor squares leave the range of the numbers.
  const V scale =
      splat_as(V{}, 1) / larger(larger(abs8(direction[0]), abs8(direction[1])), abs8(direction[2]));
  V d[3], low[2], high[2];
  for (int x = 0; x < 3; ++x) d[x] = direction[x] * scale;
  const CornersOf<V>* const of[2] = {&a, &b};
  // Ends of the projections of both triangles.
  for (int side = 0; side < 2; ++side) {
    const V x = dot(d, of[side]->x[0]), y = dot(d, of[side]->x[1]), z = dot(d, of[side]->x[2]);
    low[side] = smaller(smaller(x, y), z);
    high[side] = larger(larger(x, y), z);
  }
  // Either triangle may come first along the direction. Negative if the projections overlap.
  const V gap = larger(low[1] - high[0], low[0] - high[1]);
  const V errors = error * (abs8(d[0]) + abs8(d[1]) + abs8(d[2])) + tiny;
  return (gap - errors) / root8(dot(d, d)) * down;
}

/// As above. The errors of the corners, 2 `Between::error`, include the rounding of the products as in
/// Normal.
inline Float8 slab(const Float8* direction, const Corners& a, const Corners& b, const Between& w) {
  return slab(direction, a, b, splat(2 * w.error), splat(kKernelTiny), splat(1 - kDistanceRounding));
}

/// Float bounds on the distances of eight pairs, query units.
struct Distances {
  Float8 lower, upper;  ///< lower: 0 if nothing is proven
  Float8 towards[3];    ///< vector between the points that gave `upper`

  /// Error of the upper bound: each coordinate of the difference of two points has an error of at most 2
  /// error, as in Normal, so that 4 error covers its length.
  Distances(const Corners& a, const Corners& b, const Between& w) {
    // Upper bound: the distance of the closest points found.
    const Edges of_a(a), of_b(b);
    Float8 square = splat(__builtin_inff());
    for (Float8& x : towards) x = Float8{};
    for_close_points(a, of_a, b, of_b, [&](const FeaturePoints<Float8>& p) {
      // Lane-wise minimum. NaN compares false and is never kept.
      const Lanes nearer = greater(square, p.square);
      square = select(nearer, p.square, square);
      for (int x = 0; x < 3; ++x) towards[x] = select(nearer, p.towards[x], towards[x]);
    });
    upper = (root8(square) + splat(4 * w.error)) * splat(1 + kDistanceRounding);
    // Lower bound: first the slab normal to the line between these points. For disjoint triangles it is as
    // wide as the distance, up to rounding.
    lower = larger(slab(towards, a, b, w), Float8{});
    // Then the normals of both faces, which are accurate if the points are too close to define a direction.
    const Edges* const of[2] = {&of_a, &of_b};
    for (const Edges* t : of) {
      Float8 n[3];
      cross(t->along[0], t->along[1], n);
      lower = larger(slab(n, a, b, w), lower);
    }
  }
};

}  // namespace
}  // namespace lrb
