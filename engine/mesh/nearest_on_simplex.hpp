#pragma once
/// The closest point of a triangle or a segment.

#include <algorithm>
#include <cstdint>

#include <Eigen/Core>

#include "engine/core/geometry.hpp"

namespace lrb {

/// A point of a simplex by barycentric coordinates, which are at least 0 and add up to 1 up to rounding.
struct SimplexPoint {
  double weight[3];
  double distance_sq;  ///< squared distance from the query point
};

/// Returns the point of the segment a, b closest to p, up to rounding. The distance is that of an actual
/// point of the segment, so it is never below the true one (up to rounding of the result). The same applies
/// to triangles.
inline SimplexPoint nearest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a, ap = p - a;
  const double along = dot3(ab, ap), length_sq = squared_norm3(ab);
  if (!(along > 0)) return {{1, 0, 0}, squared_norm3(ap)};
  if (!(along < length_sq)) return {{0, 1, 0}, squared_norm3(p - b)};
  const double t = along / length_sq;
  return {{1 - t, t, 0}, squared_norm3(ap - t * ab)};
}

/// Returns the closest point of a triangle, possibly without area (Ericson, "Real-Time Collision Detection",
/// 5.1.5).
inline SimplexPoint nearest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot3(ab, ap), d2 = dot3(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {{1, 0, 0}, squared_norm3(ap)};
  const Eigen::Vector3d bp = p - b;
  const double d3 = dot3(ab, bp), d4 = dot3(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {{0, 1, 0}, squared_norm3(bp)};
  const Eigen::Vector3d cp = p - c;
  const double d5 = dot3(ab, cp), d6 = dot3(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {{0, 0, 1}, squared_norm3(cp)};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) {
    const double t = d1 / (d1 - d3);
    return {{1 - t, t, 0}, squared_norm3(ap - t * ab)};
  }
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) {
    const double t = d2 / (d2 - d6);
    return {{1 - t, 0, t}, squared_norm3(ap - t * ac)};
  }
  if (va <= 0 && d4 >= d3 && d5 >= d6 && (d4 - d3) + (d5 - d6) > 0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {{0, 1 - t, t}, squared_norm3(bp - t * (c - b))};
  }
  const double sum = va + vb + vc;
  if (!(va >= 0 && vb >= 0 && vc >= 0 && sum > 0)) {  // rounding, or no area
    SimplexPoint best = nearest_on_segment(p, a, b);
    const SimplexPoint bc = nearest_on_segment(p, b, c), ca = nearest_on_segment(p, c, a);
    if (bc.distance_sq < best.distance_sq) best = {{0, bc.weight[0], bc.weight[1]}, bc.distance_sq};
    if (ca.distance_sq < best.distance_sq) best = {{ca.weight[1], 0, ca.weight[0]}, ca.distance_sq};
    return best;
  }
  const double v = vb / sum, w = vc / sum;
  return {{1 - v - w, v, w}, squared_norm3(ap - v * ab - w * ac)};
}

/// The part of a triangle a, b, c that has the closest point.
enum class TrianglePart : std::uint8_t { inside, edge_ab, edge_bc, edge_ca, corner_a, corner_b, corner_c };

template <class Scalar>
struct ClosestPart {
  Scalar distance_sq;
  TrianglePart part;
};

/// Returns the squared distance from a point to an actual point of a triangle (up to rounding), the closest
/// one unless the triangle is nearly degenerate: as nearest_on_triangle(), but the interior is tested first,
/// which is faster where most points project onto it, and there is no weight. `ab`, `ac`, `ap`: the other
/// corners and the point, relative to a.
template <class Scalar>
ClosestPart<Scalar> closest_part(const Eigen::Matrix<Scalar, 3, 1>& ab, const Eigen::Matrix<Scalar, 3, 1>& ac,
                                 const Eigen::Matrix<Scalar, 3, 1>& ap) {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  using enum TrianglePart;
  // In one order on all machines, as dot3().
  const auto dot = [](const Vector& u, const Vector& v) { return (u[0] * v[0] + u[1] * v[1]) + u[2] * v[2]; };
  const auto from = [&](const Vector& q, TrianglePart part) { return ClosestPart<Scalar>{dot(q, q), part}; };
  const Scalar d1 = dot(ab, ap), d2 = dot(ac, ap);
  const Scalar bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
  const Scalar vb = cc * d1 - bc * d2, vc = bb * d2 - bc * d1, all = bb * cc - bc * bc;
  if (vb >= 0 && vc >= 0 && vb + vc <= all && all > 0)
    return from(ap - (vb / all) * ab - (vc / all) * ac, inside);
  const Scalar d3 = d1 - bb, d4 = d2 - bc, d5 = d1 - bc, d6 = d2 - cc;
  if (d1 <= 0 && d2 <= 0) return from(ap, corner_a);
  if (d3 >= 0 && d4 <= d3) return from(ap - ab, corner_b);
  if (d6 >= 0 && d5 <= d6) return from(ap - ac, corner_c);
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return from(ap - (d1 / bb) * ab, edge_ab);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return from(ap - (d2 / cc) * ac, edge_ca);
  const Scalar length = (d4 - d3) + (d5 - d6);
  const Scalar share = length > 0 ? std::clamp((d4 - d3) / length, Scalar(0), Scalar(1)) : Scalar(0);
  return from(ap - ab - share * (ac - ab), edge_bc);
}

}  // namespace lrb
