/// Bounds the distance of two simplices in double. Steps:
/// 1. Find the closest points among edge-edge pairs (Ericson, "Real-Time Collision Detection", 5.1.9, after
///    Lumelsky 1985) and vertex-plane pairs. Their distance is the upper bound.
/// 2. Find a lower bound as the width of a slab between the simplices. For any direction n they are separated
///    by at least
///     (least n . b over the corners of B - largest n . a over the corners of A) / |n|.
///
/// This bound is valid whatever errors n has; only the rounding of the products counts. The best n is the
/// direction between the closest points. Their difference loses digits if the simplices are close to each
/// other, so n is also computed from the edges of the closest features: the common normal of both edges, the
/// normal of the face, or the normal of one edge towards the other point.
///
/// Errors. Let R be the largest coordinate of any corner, relative to A's first corner, and u = 2^-53. The
/// error of a coordinate is at most u R (one subtraction). It adds u R |n|_1 to the error of a product n . x,
/// whose three products and two sums add 3 u R |n|_1. The difference of two products has at most twice that
/// error, plus its own rounding: less than 16 u R |n|_1. The vector between two points at given parameters of
/// their edges has an error of at most 20 u R in each coordinate: 4 u R for the vector between corners, 6 u R
/// for each of two edges times a parameter, 4 u R for two sums. The error of its length is at most 35 u R.
/// The two parameters of a face may add up to 1 + u, which adds 4 u R. kPairRounding is 64 u.

#include "engine/distance/pair_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "engine/core/axes.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

double clamp_share(double x) {
  return x > 0 ? std::min(x, 1.0) : 0;  // NaN: 0
}

/// Two points, by the features that contain them and their parameters along these features' edges.
struct Nearest {
  double square = kInfinity;
  Vector3d towards{0, 0, 0};  ///< from the point of A to the point of B
  exact::Feature on[2];
  double share[2][2] = {};
};

constexpr double kPairUp = 1 + 0x1p-51, kPairDown = 1 - 0x1p-50;

/// Returns true if squares of lengths, and their products, neither overflow nor underflow.
bool is_in_range(double length) {
  return length > 0x1p-200 && length < 0x1p200;
}

/// Returns the width of the slab between two simplices along a direction of any length, rounded down; at
/// least 0. gap: gap_along() the direction. reach: the largest coordinate from which it was computed.
double slab_width(const Vector3d& direction, double gap, double reach) {
  // A quarter of kPairRounding is 16 u: the error bound of a difference of products, derived above.
  const double sure = gap - 0.25 * kPairRounding * reach * direction.cwiseAbs().sum();
  return sure > 0 ? sure / direction.norm() * kPairDown : 0;
}

class Pair {
 public:
  Pair(const double* const* a, const double* const* b, int n) : n_(n) {
    // Relative to A's first corner: errors scale with the simplices, not with their distance from the origin.
    for (int axis = 0; axis < n; ++axis)
      for (int k = 0; k < n; ++k) {
        x_[0][k][axis] = a[k][axis] - a[0][axis];
        x_[1][k][axis] = b[k][axis] - a[0][axis];
        reach_ = std::max({reach_, std::abs(x_[0][k][axis]), std::abs(x_[1][k][axis])});
      }
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < n; ++k) edge_[side][k] = x_[side][(k + 1) % n] - x_[side][k];
  }

  bool is_in_range() const { return lrb::is_in_range(reach_); }

  void find() {
    // Closest points of disjoint simplices are on two edges or, in 3D, on a vertex and a face.
    for (int i = 0; i < edges(); ++i)
      for (int j = 0; j < edges(); ++j) edge_to_edge(i, j);
    if (n_ != 3) return;
    for (int side = 0; side < 2; ++side) corners_to_face(side);
  }

  const Nearest& nearest() const { return nearest_; }
  double upper() const { return (std::sqrt(nearest_.square) + kPairRounding * reach_) * kPairUp; }

  /// Returns the lower bound, and writes the direction that gave it.
  double lower(Vector3d& direction) const {
    double most = 0;
    const auto try_direction = [&](const Vector3d& n) {
      const double wide = width(n);
      if (!(wide > most)) return;
      most = wide;
      direction = n;
    };
    // Candidates, the most promising first. The vector between the closest points: best if it is long.
    try_direction(nearest_.towards);
    // The normal of the closest features: accurate even if the points nearly coincide.
    try_direction(across_features());
    // Last, the faces' normals, if the interval is wider than rounding explains.
    if (n_ == 3)
      for (const auto& edge : edge_)
        if (most < upper() - 2 * kPairRounding * reach_) try_direction(edge[0].cross(edge[1]));
    return most;
  }

 private:
  int edges() const { return n_ == 3 ? 3 : 1; }

  /// Closest points of two edges (Ericson 5.1.9).
  void edge_to_edge(int i, int j) {
    const Vector3d &u = edge_[0][i], &v = edge_[1][j];
    const Vector3d towards = x_[1][j] - x_[0][i];
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(towards),
                 vw = v.dot(towards);
    // Minimise over both lines and clamp. Parallel edges yield NaN or any value: every s is equally good
    // then.
    double s = clamp_share((vv * uw - uv * vw) / (uu * vv - uv * uv));
    // Project that point on the other edge, and back: each time the closest point of a segment to the other
    // point.
    const double t = clamp_share((uv * s - vw) / vv);
    s = clamp_share((uv * t + uw) / uu);
    const Vector3d d = towards + t * v - s * u;
    const double square = d.squaredNorm();
    if (!(square < nearest_.square)) return;
    nearest_ = {square, d, {on_edge(i, s), on_edge(j, t)}, {{s, 0}, {t, 0}}};
  }

  exact::Feature on_edge(int k, double share) const {
    // Clamped parameters are exactly 0 or 1: the point is a corner.
    if (share <= 0) return {0, static_cast<std::uint8_t>(k)};
    if (share >= 1) return {0, static_cast<std::uint8_t>((k + 1) % n_)};
    return {1, static_cast<std::uint8_t>(k)};
  }

  /// Projects the vertices of the other simplex on the face of `side`.
  void corners_to_face(int side) {
    const Vector3d &u = edge_[side][0], v = -edge_[side][2], &first = x_[side][0];
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), area = uu * vv - uv * uv;
    // The squared doubled area. A face without area is covered by its edges.
    if (!(area > 0)) return;
    for (int k = 0; k < 3; ++k) {
      const Vector3d towards = x_[1 - side][k] - first;
      const double uw = u.dot(towards), vw = v.dot(towards);
      // Barycentric coordinates of the projection (normal equations, Cramer's rule).
      const double s = (vv * uw - uv * vw) / area, t = (uu * vw - uv * uw) / area;
      // Outside the face, or NaN: an edge is closer.
      if (!(s > 0 && t > 0 && s + t < 1)) continue;
      const Vector3d d = towards - s * u - t * v;
      const double square = d.squaredNorm();
      if (!(square < nearest_.square)) continue;
      nearest_.square = square;
      // The vector runs from A to B, whichever has the face.
      nearest_.towards = side == 0 ? d : Vector3d(-d);
      nearest_.on[side] = {2, 0};
      nearest_.on[1 - side] = {0, static_cast<std::uint8_t>(k)};
      nearest_.share[side][0] = s;
      nearest_.share[side][1] = t;
    }
  }

  /// Returns a normal of the closest features that stays accurate if they nearly touch.
  Vector3d across_features() const {
    const exact::Feature &a = nearest_.on[0], &b = nearest_.on[1];
    // A face: its own normal.
    if (a.dim == 2) return edge_[0][0].cross(edge_[0][1]);
    if (b.dim == 2) return edge_[1][0].cross(edge_[1][1]);
    // Two edges: their common normal, unless they are parallel.
    if (a.dim == 1 && b.dim == 1 && n_ == 3) {
      const Vector3d n = edge_[0][a.index].cross(edge_[1][b.index]);
      if (n.squaredNorm() > 0) return n;
    }
    // A vertex and an edge, or parallel edges. For two vertices there is only their difference.
    const Vector3d* along = a.dim == 1 ? &edge_[0][a.index] : b.dim == 1 ? &edge_[1][b.index] : nullptr;
    if (along == nullptr) return nearest_.towards;
    // 2D: the normal of the edge. 3D: the difference without its component along the edge (Gram-Schmidt).
    if (n_ == 2) return {-along->y(), along->x(), 0};
    return nearest_.towards - nearest_.towards.dot(*along) / along->squaredNorm() * *along;
  }

  /// Returns the width of the slab between the simplices along a direction of any length, rounded down; at
  /// least 0.
  double width(Vector3d n) const {
    const double largest = n.cwiseAbs().maxCoeff();
    if (!(largest > 0)) return 0;
    // Scale by a power of two, which is exact, so that the largest coordinate is in [1, 2).
    n *= std::ldexp(1.0, -std::ilogb(largest));
    const auto corners = static_cast<std::size_t>(n_);
    return slab_width(n, gap_along(n, std::span(x_[0], corners), std::span(x_[1], corners)), reach_);
  }

  int n_;
  Vector3d x_[2][3] = {{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()},
                       {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()}};
  Vector3d edge_[2][3];
  double reach_ = 0;
  Nearest nearest_;
};

/// Returns the point of a simplex at given parameters along the feature's edges, in the world.
Vector3d place(const exact::Feature& on, const double* share, const double* const* corners, int n) {
  const auto at = [&](int k) {
    const double* x = corners[k % n];
    return Vector3d(x[0], x[1], n == 3 ? x[2] : 0);
  };
  // A vertex is copied, without rounding.
  if (on.dim == 0) return at(on.index);
  const int first = on.dim == 1 ? on.index : 0;
  const Vector3d from = at(first);
  // First corner plus parameters times one or two edges, in world coordinates.
  Vector3d x = from + share[0] * (at(first + 1) - from);
  if (on.dim == 2) x += share[1] * (at(2) - from);
  return x;
}

}  // namespace

PairBounds bound_distance(const double* const* a, const double* const* b, int n) {
  Pair pair(a, b, n);
  PairBounds out;
  out.upper = kInfinity;
  // Squares would overflow or underflow: the caller needs exact arithmetic.
  if (!pair.is_in_range()) return out;
  pair.find();
  const Nearest& nearest = pair.nearest();
  out.upper = pair.upper();
  // Only rounding can raise the lower bound above the upper one.
  out.lower = std::min(pair.lower(out.direction), out.upper);
  for (int side = 0; side < 2; ++side) {
    out.on[side] = nearest.on[side];
    out.point[side] = place(nearest.on[side], nearest.share[side], side == 0 ? a : b, n);
  }
  return out;
}

/// As Pair::width(), without the set-up that only Pair::find() needs.
double distance_along(const Vector3d& direction, double least, const double* const* a, const double* const* b,
                      int n) {
  double low[2] = {kInfinity, kInfinity}, high[2] = {-kInfinity, -kInfinity}, reach = 0;
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < n; ++k) {
      double ahead = 0;
      for (int axis = 0; axis < n; ++axis) {
        // Relative to A's first corner, as in Pair.
        const double x = (side == 0 ? a : b)[k][axis] - a[0][axis];
        reach = std::max(reach, std::abs(x));
        ahead += direction[axis] * x;
      }
      low[side] = std::min(low[side], ahead);
      high[side] = std::max(high[side], ahead);
    }
  // Outside this range squares are unreliable: no result.
  if (!is_in_range(reach) || !is_in_range(direction.cwiseAbs().maxCoeff())) return 0;
  const double width = slab_width(direction, std::max(low[1] - high[0], low[0] - high[1]), reach);
  // Clearly below `least`: the caller computes the full bounds, which may be larger.
  return width < least - 2 * kPairRounding * reach ? 0 : width;
}

}  // namespace lrb
