#pragma once
/// The squared distance of two simplices in rational arithmetic. For every pair of features (corner, edge,
/// triangle) the closest points of their planes are computed from the normal equations, and count if they lie
/// in both features. Shares no code and no formula with the engine.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>

namespace lrb::oracle {

using Rational = boost::multiprecision::cpp_rational;  // represents doubles exactly

using Corners = std::vector<Eigen::Vector3d>;  ///< 1 to 3 points

/// Returns the unique solution of linear equations (rows: coefficients, then the right side; at least as many
/// as unknowns), or nullopt without a unique one.
inline std::optional<std::vector<Rational>> unique_solution(std::vector<std::vector<Rational>> m) {
  const std::size_t n = m.empty() ? 0 : m[0].size() - 1;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t r = c;
    while (r < m.size() && m[r][c] == 0) ++r;
    if (r == m.size()) return std::nullopt;
    std::swap(m[r], m[c]);
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (i == c || m[i][c] == 0) continue;
      const Rational f = m[i][c] / m[c][c];
      for (std::size_t k = c; k <= n; ++k) m[i][k] -= f * m[c][k];
    }
  }
  for (std::size_t i = n; i < m.size(); ++i)
    if (m[i][n] != 0) return std::nullopt;
  std::vector<Rational> x;
  for (std::size_t i = 0; i < n; ++i) x.push_back(m[i][n] / m[i][i]);
  return x;
}

using RationalPoints = std::vector<std::array<Rational, 3>>;

inline Rational dot(const std::array<Rational, 3>& x, const std::array<Rational, 3>& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
inline std::array<Rational, 3> minus(const std::array<Rational, 3>& x, const std::array<Rational, 3>& y) {
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}

/// The closest points of two features, and their squared distance.
struct RationalClosest {
  std::array<Rational, 3> on_f, on_g;
  Rational distance_sq;
};

/// Returns the closest points of the planes of two features, or nullopt if they are not in the features.
inline std::optional<RationalClosest> closest_of_features(const RationalPoints& f, const RationalPoints& g) {
  std::vector<std::array<Rational, 3>> ways;  // along f, then against g
  for (std::size_t k = 1; k < f.size(); ++k) ways.push_back(minus(f[k], f[0]));
  for (std::size_t k = 1; k < g.size(); ++k) ways.push_back(minus(g[0], g[k]));
  const std::array<Rational, 3> between = minus(g[0], f[0]);
  std::vector<std::vector<Rational>> m(ways.size());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (const auto& direction : ways) m[i].push_back(dot(ways[i], direction));
    m[i].push_back(dot(ways[i], between));
  }
  const auto share = unique_solution(m);
  if (!share) return std::nullopt;
  Rational sum[2] = {0, 0};
  RationalClosest out{f[0], g[0], 0};
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if ((*share)[i] < 0) return std::nullopt;
    const bool of_f = i + 1 < f.size();
    sum[of_f ? 0 : 1] += (*share)[i];
    for (std::size_t x = 0; x < 3; ++x) {
      if (of_f)
        out.on_f[x] += (*share)[i] * ways[i][x];
      else
        out.on_g[x] -= (*share)[i] * ways[i][x];
    }
  }
  if (sum[0] > 1 || sum[1] > 1) return std::nullopt;
  const std::array<Rational, 3> left = minus(out.on_g, out.on_f);
  out.distance_sq = dot(left, left);
  return out;
}

/// Returns the features of a simplex: its corners, edges and interior.
inline std::vector<RationalPoints> features_of(const RationalPoints& corners) {
  std::vector<RationalPoints> all;
  for (unsigned which = 1; which < 1U << corners.size(); ++which) {
    RationalPoints points;
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (which >> k & 1) points.push_back(corners[k]);
    all.push_back(points);
  }
  return all;
}

/// Returns closest points of two simplices.
inline RationalClosest closest_points(const RationalPoints& a, const RationalPoints& b) {
  std::optional<RationalClosest> least;
  for (const RationalPoints& f : features_of(a))
    for (const RationalPoints& g : features_of(b)) {
      const auto d = closest_of_features(f, g);
      if (d && (!least || d->distance_sq < least->distance_sq)) least = d;
    }
  return *least;
}

using RationalPoint = std::array<Rational, 3>;

inline RationalPoint rational(const Eigen::Vector3d& x) {
  return {Rational(x[0]), Rational(x[1]), Rational(x[2])};
}
inline RationalPoints rational(const Corners& corners) {
  RationalPoints out;
  for (const Eigen::Vector3d& x : corners) out.push_back(rational(x));
  return out;
}

inline RationalClosest closest_points(const Corners& a, const Corners& b) {
  return closest_points(rational(a), rational(b));
}
inline Rational distance_sq(const Corners& a, const Corners& b) {
  return closest_points(a, b).distance_sq;
}

inline Rational square(double x) {
  const Rational r(x);
  return r * r;
}

// The time of first contact of two sets of triangles in rational arithmetic. One set translates at constant
// velocity. Triangles first intersect when a corner enters the plane of the other's face, or two
// edges become coplanar. Each such time is a rational number, and rational distances decide whether the
// triangles intersect at that time. Triangles must not slide within the plane of a face that they intersect.
// Shares no code with the engine.

inline RationalPoint cross(const RationalPoint& x, const RationalPoint& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
inline RationalPoint moved(const RationalPoint& x, const RationalPoint& direction, const Rational& t) {
  return {x[0] + t * direction[0], x[1] + t * direction[1], x[2] + t * direction[2]};
}

/// Returns true if two simplices intersect.
inline bool simplices_meet(const RationalPoints& a, const RationalPoints& b) {
  for (const RationalPoints& f : features_of(a))
    for (const RationalPoints& g : features_of(b)) {
      const auto d = closest_of_features(f, g);
      if (d && d->distance_sq == 0) return true;
    }
  return false;
}

/// Returns true if doubles prove that two triangles are disjoint: separated by more than a billionth of their
/// sizes and distance, along a normal or a cross product of two edges. Coordinates are relative to a corner,
/// so that precision does not depend on the distance to the world's origin.
inline bool clearly_apart(const RationalPoints& a, const RationalPoints& b) {
  std::array<Eigen::Vector3d, 3> x[2];
  double size = 0;
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        x[side][k][i] = Rational((side == 0 ? a : b)[k][axis] - a[0][axis]).convert_to<double>();
        size = std::max(size, std::abs(x[side][k][i]));
      }
  if (size == 0) return false;
  for (auto& corners : x)
    for (Eigen::Vector3d& p : corners) p /= size;
  const auto edge = [&](std::size_t side, std::size_t k) -> Eigen::Vector3d {
    return x[side][(k + 1) % 3] - x[side][k];
  };
  const auto parts = [&](const Eigen::Vector3d& n) {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (std::size_t side = 0; side < 2; ++side)
      for (const Eigen::Vector3d& p : x[side]) {
        low[side] = std::min(low[side], n.dot(p));
        high[side] = std::max(high[side], n.dot(p));
      }
    const double slack = 1e-9 * n.lpNorm<1>();
    return low[0] - high[1] > slack || low[1] - high[0] > slack;
  };
  if (parts(edge(0, 0).cross(edge(0, 1))) || parts(edge(1, 0).cross(edge(1, 1)))) return true;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < 3; ++j)
      if (parts(edge(0, k).cross(edge(1, j)))) return true;
  return false;
}

/// Returns the first t in [0, 1], at most `before`, at which triangle b, translated by t * `by`, intersects
/// triangle a. Returns nullopt if there is no such t.
inline std::optional<Rational> first_time(const RationalPoints& of_a, const RationalPoints& of_b,
                                          const RationalPoint& by, const Rational& before = 1) {
  std::vector<Rational> times = {0};
  /// Adds the time at which `from` + sign * t * `by` is in the plane through 0 with normal n.
  const auto add = [&](const RationalPoint& n, const RationalPoint& from, const Rational& sign) {
    const Rational speed = sign * dot(n, by);
    if (speed == 0) return;
    const Rational t = -dot(n, from) / speed;
    if (t >= 0 && t <= before) times.push_back(t);
  };
  const RationalPoint face_a = cross(minus(of_a[1], of_a[0]), minus(of_a[2], of_a[0]));
  const RationalPoint face_b = cross(minus(of_b[1], of_b[0]), minus(of_b[2], of_b[0]));
  for (std::size_t k = 0; k < 3; ++k) {
    add(face_a, minus(of_b[k], of_a[0]), 1);
    add(face_b, minus(of_a[k], of_b[0]), -1);
    for (std::size_t j = 0; j < 3; ++j)
      add(cross(minus(of_a[(k + 1) % 3], of_a[k]), minus(of_b[(j + 1) % 3], of_b[j])),
          minus(of_b[j], of_a[k]), 1);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  for (const Rational& t : times) {
    RationalPoints there;
    for (const RationalPoint& x : of_b) there.push_back(moved(x, by, t));
    if (!clearly_apart(of_a, there) && simplices_meet(of_a, there)) return t;
  }
  return std::nullopt;
}

inline std::optional<Rational> first_time(const Corners& a, const Corners& b,
                                          const Eigen::Vector3d& direction, const Rational& before = 1) {
  return first_time(rational(a), rational(b), rational(direction), before);
}

}  // namespace lrb::oracle
