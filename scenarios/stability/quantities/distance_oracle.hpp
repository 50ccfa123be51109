#pragma once
/// The squared distance of two simplices in rational arithmetic, by the textbook: for every pair of features
/// (corner, edge, triangle) the nearest points of their planes are found from the normal equations, and count
/// if they lie in both features. Shares no code and no formula with the engine.

#include <array>
#include <optional>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

namespace lrb::oracle {

using Rational = boost::multiprecision::cpp_rational;  // what a double is, exactly

using Corners = std::vector<std::array<double, 3>>;  ///< 1 to 3 points

/// Solves a linear system in place; none if it is singular.
inline std::optional<std::vector<Rational>> solve(std::vector<std::vector<Rational>> m,
                                                  std::vector<Rational> r) {
  const std::size_t n = r.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t pivot = i;
    while (pivot < n && m[pivot][i] == 0) ++pivot;
    if (pivot == n) return std::nullopt;
    std::swap(m[i], m[pivot]);
    std::swap(r[i], r[pivot]);
    for (std::size_t k = 0; k < n; ++k) {
      if (k == i || m[k][i] == 0) continue;
      const Rational f = m[k][i] / m[i][i];
      for (std::size_t j = i; j < n; ++j) m[k][j] -= f * m[i][j];
      r[k] -= f * r[i];
    }
  }
  for (std::size_t i = 0; i < n; ++i) r[i] /= m[i][i];
  return r;
}

using RationalPoints = std::vector<std::array<Rational, 3>>;

inline Rational dot(const std::array<Rational, 3>& x, const std::array<Rational, 3>& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
inline std::array<Rational, 3> minus(const std::array<Rational, 3>& x, const std::array<Rational, 3>& y) {
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}

/// Returns the squared distance of the planes of two features if their nearest points lie in the features.
inline std::optional<Rational> feature_distance_sq(const RationalPoints& f, const RationalPoints& g) {
  std::vector<std::array<Rational, 3>> ways;  // along f, then against g
  for (std::size_t k = 1; k < f.size(); ++k) ways.push_back(minus(f[k], f[0]));
  for (std::size_t k = 1; k < g.size(); ++k) ways.push_back(minus(g[0], g[k]));
  const std::array<Rational, 3> between = minus(g[0], f[0]);
  std::vector<std::vector<Rational>> m(ways.size(), std::vector<Rational>(ways.size()));
  std::vector<Rational> r(ways.size());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    r[i] = dot(ways[i], between);
    for (std::size_t j = 0; j < ways.size(); ++j) m[i][j] = dot(ways[i], ways[j]);
  }
  const auto share = solve(m, r);
  if (!share) return std::nullopt;
  Rational sum[2] = {0, 0};
  std::array<Rational, 3> left = between;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if ((*share)[i] < 0) return std::nullopt;
    sum[i + 1 < f.size() ? 0 : 1] += (*share)[i];
    for (std::size_t x = 0; x < 3; ++x) left[x] -= (*share)[i] * ways[i][x];
  }
  if (sum[0] > 1 || sum[1] > 1) return std::nullopt;
  return dot(left, left);
}

inline Rational distance_sq(const Corners& a, const Corners& b) {
  const auto features = [](const Corners& c) {
    std::vector<RationalPoints> all;
    for (unsigned which = 1; which < 1U << c.size(); ++which) {
      RationalPoints points;
      for (std::size_t k = 0; k < c.size(); ++k)
        if (which >> k & 1) points.push_back({Rational(c[k][0]), Rational(c[k][1]), Rational(c[k][2])});
      all.push_back(points);
    }
    return all;
  };
  std::optional<Rational> least;
  for (const RationalPoints& f : features(a))
    for (const RationalPoints& g : features(b)) {
      const auto d = feature_distance_sq(f, g);
      if (d && (!least || *d < *least)) least = d;
    }
  return *least;
}

inline Rational square(double x) {
  const Rational r(x);
  return r * r;
}

}  // namespace lrb::oracle
