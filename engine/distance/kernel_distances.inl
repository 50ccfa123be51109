#pragma once
// Part of distance_kernel.inl: the distances of eight pairs of triangles.

#include "engine/tree/kernel_triangles.inl"

namespace lrb {
namespace {

inline Float8 smaller(Float8 x, Float8 y) {
  return select(greater(x, y), y, x);
}

inline Float8 dot8(const Float8* x, const Float8* y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/// Clamps x to [0, 1]; NaN becomes 0.
inline Float8 clamp_share(Float8 x) {
  return smaller(larger(x, Float8{}), splat(1));
}

/// The edges of eight triangles, with their squared lengths and the reciprocals of these.
struct Edges {
  Float8 along[3][3], square[3], per_square[3];

  explicit Edges(const Corners& t) {
    for (int i = 0; i < 3; ++i) {
      subtract(t.x[(i + 1) % 3], t.x[i], along[i]);
      // Infinite for an edge without length: the NaN that follows is clamped to 0.
      square[i] = dot8(along[i], along[i]);
      per_square[i] = splat(1) / square[i];
    }
  }
};

/// Finds close points of eight pairs of triangles: the vectors between them and their squared lengths. The
/// cases edge-edge and vertex-face are as in Ericson, "Real-Time Collision Detection", 5.1. Whatever is
/// rounded, the points are in their triangles, so each length is at least the distance, up to the errors of
/// the corners. Whether it is the minimum is not guaranteed.
struct NearestPoints {
  Float8 way[3] = {}, square = splat(__builtin_inff());  ///< from A to B

  NearestPoints(const Corners& a, const Edges& of_a, const Corners& b, const Edges& of_b) {
    // Closest points of disjoint triangles lie on two edges, or on a vertex and a face: 9 + 6 cases.
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) edge_to_edge(a, of_a, i, b, of_b, j);
    corners_to_face(a, of_a, b, splat(1));
    corners_to_face(b, of_b, a, splat(-1));
  }

 private:
  void edge_to_edge(const Corners& a, const Edges& of_a, int i, const Corners& b, const Edges& of_b, int j) {
    const Float8 *u = of_a.along[i], *v = of_b.along[j];
    Float8 between[3], d[3];
    // Closest points of two segments (Ericson 5.1.9, after Lumelsky 1985).
    subtract(b.x[j], a.x[i], between);
    const Float8 uv = dot8(u, v), uw = dot8(u, between), vw = dot8(v, between);
    // The denominator is |u|^2 |v|^2 sin^2 of the angle, which is about 0 for parallel edges: any clamped s
    // will do then.
    const Float8 sine = of_a.square[i] * of_b.square[j] - uv * uv;
    Float8 s = clamp_share((of_b.square[j] * uw - uv * vw) / sine);
    // Alternate projections: the closest point of the other segment, then of this one. Both stay on their
    // segments.
    const Float8 t = clamp_share((uv * s - vw) * of_b.per_square[j]);
    s = clamp_share((uv * t + uw) * of_a.per_square[i]);
    for (int x = 0; x < 3; ++x) d[x] = between[x] + t * v[x] - s * u[x];
    keep(d, dot8(d, d), splat(1));
  }

  /// Projects the corners of `points` on the faces of `t`.
  void corners_to_face(const Corners& t, const Edges& of, const Corners& points, Float8 turn) {
    const Float8* u = of.along[0];
    Float8 v[3];
    subtract(t.x[2], t.x[0], v);
    // Barycentric coordinates of the projection: normal equations in u and v, by Cramer's rule.
    const Float8 uu = of.square[0], vv = of.square[2], uv = dot8(u, v);
    const Float8 per_area = splat(1) / (uu * vv - uv * uv);
    for (const auto& point : points.x) {
      Float8 w[3], d[3];
      subtract(point, t.x[0], w);
      const Float8 uw = dot8(u, w), vw = dot8(v, w);
      const Float8 s = (vv * uw - uv * vw) * per_area, rest = (uu * vw - uv * uw) * per_area;
      // Outside the face an edge is closer, found by edge_to_edge(). A face without area yields NaN: not
      // inside.
      const Lanes inside =
          both(both(greater(s, Float8{}), greater(rest, Float8{})), greater(splat(1), s + rest));
      for (int x = 0; x < 3; ++x) d[x] = w[x] - s * u[x] - rest * v[x];
      keep(d, select(inside, dot8(d, d), splat(__builtin_inff())), turn);
    }
  }

  void keep(const Float8* d, Float8 length_sq, Float8 turn) {
    // Lane-wise minimum. NaN compares false and is never kept.
    const Lanes nearer = greater(square, length_sq);
    square = select(nearer, length_sq, square);
    for (int x = 0; x < 3; ++x) way[x] = select(nearer, d[x] * turn, way[x]);
  }
};

/// Returns lower bounds on the distances of eight pairs: the width of the slab between them along a direction
/// of any length. Any direction is valid, however it was found: only the errors of the corners count, 2 error
/// |d|_1, which includes the rounding of the products as in Normal. A direction of length 0 yields NaN, which
/// proves nothing.
inline Float8 slab(const Float8* direction, const Corners& a, const Corners& b, const Between& w) {
  // Scale by the largest coordinate, so that neither products nor squares leave the range of floats.
  const Float8 scale = splat(1) / larger(larger(abs8(direction[0]), abs8(direction[1])), abs8(direction[2]));
  Float8 d[3], low[2], high[2];
  for (int x = 0; x < 3; ++x) d[x] = direction[x] * scale;
  const Corners* const of[2] = {&a, &b};
  // Ends of the projections of both triangles.
  for (int side = 0; side < 2; ++side) {
    const Float8 x = dot8(d, of[side]->x[0]), y = dot8(d, of[side]->x[1]), z = dot8(d, of[side]->x[2]);
    low[side] = smaller(smaller(x, y), z);
    high[side] = larger(larger(x, y), z);
  }
  // Either triangle may come first along the direction. Negative if the projections overlap.
  const Float8 gap = larger(low[1] - high[0], low[0] - high[1]);
  const Float8 errors = splat(2 * w.error) * (abs8(d[0]) + abs8(d[1]) + abs8(d[2])) + splat(kKernelTiny);
  // Divide by the length last; the factor covers the rounding of the root and of the quotient.
  return (gap - errors) / root8(dot8(d, d)) * splat(1 - kDistanceRounding);
}

/// Float bounds on the distances of eight pairs, query units.
struct Distances {
  Float8 lower, upper;  ///< lower: 0 if nothing is proven
  Float8 way[3];        ///< vector between the points that gave `upper`

  /// Error of the upper bound: each coordinate of the difference of two points has an error of at most 2
  /// error, as in Normal, so that 4 error covers its length.
  Distances(const Corners& a, const Corners& b, const Between& w) {
    // Upper bound: the distance of the closest points found.
    const Edges of_a(a), of_b(b);
    const NearestPoints nearest(a, of_a, b, of_b);
    upper = (root8(nearest.square) + splat(4 * w.error)) * splat(1 + kDistanceRounding);
    for (int x = 0; x < 3; ++x) way[x] = nearest.way[x];
    // Lower bound: first the slab normal to the line between these points. For disjoint triangles it is as
    // wide as the distance, up to rounding.
    lower = larger(slab(way, a, b, w), Float8{});
    // Then the normals of both faces, which are accurate if the points are too close to define a direction.
    const Edges* const of[2] = {&of_a, &of_b};
    for (const Edges* t : of) {
      Float8 n[3];
      for (int x = 0; x < 3; ++x) {
        const int y = (x + 1) % 3, z = (x + 2) % 3;
        n[x] = t->along[0][y] * t->along[1][z] - t->along[0][z] * t->along[1][y];
      }
      lower = larger(slab(n, a, b, w), lower);
    }
  }
};

}  // namespace
}  // namespace lrb
