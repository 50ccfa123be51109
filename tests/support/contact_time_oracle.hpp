#pragma once
/// When two sets of triangles first meet as one of them moves straight, in rational arithmetic. Triangles first meet
/// where a corner comes into the plane of the other's face, or two edges come into one plane: each such time is a
/// rational number, and whether they meet then is decided by rational distances. Triangles must not move within the
/// plane of a face that they meet. Shares no code with the engine.

#include <algorithm>
#include <optional>
#include <vector>

#include "tests/support/distance_oracle.hpp"

namespace lrb::oracle {

using RationalPoint = std::array<Rational, 3>;

inline RationalPoint rational(const std::array<double, 3>& x) {
  return {Rational(x[0]), Rational(x[1]), Rational(x[2])};
}
inline RationalPoint cross(const RationalPoint& x, const RationalPoint& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
inline RationalPoint moved(const RationalPoint& x, const RationalPoint& way, const Rational& t) {
  return {x[0] + t * way[0], x[1] + t * way[1], x[2] + t * way[2]};
}

/// Returns true if two triangles meet.
inline bool triangles_meet(const RationalPoints& a, const RationalPoints& b) {
  const auto features = [](const RationalPoints& c) {
    std::vector<RationalPoints> all;
    for (unsigned which = 1; which < 8; ++which) {
      RationalPoints points;
      for (std::size_t k = 0; k < 3; ++k)
        if (which >> k & 1) points.push_back(c[k]);
      all.push_back(points);
    }
    return all;
  };
  for (const RationalPoints& f : features(a))
    for (const RationalPoints& g : features(b)) {
      const auto d = feature_distance_sq(f, g);
      if (d && *d == 0) return true;
    }
  return false;
}

/// Returns the first t from 0 to 1, no later than `before`, at which triangle b, moved by t times `way`, meets triangle
/// a; none if there is none.
inline std::optional<Rational> first_time(const Corners& a, const Corners& b,
                                          const std::array<double, 3>& way, const Rational& before = 1) {
  RationalPoints of_a, of_b;
  for (const auto& x : a) of_a.push_back(rational(x));
  for (const auto& x : b) of_b.push_back(rational(x));
  const RationalPoint by = rational(way);
  std::vector<Rational> times = {0};
  /// Adds when `from` + t `turn` is in the plane across n.
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
    if (triangles_meet(of_a, there)) return t;
  }
  return std::nullopt;
}

}  // namespace lrb::oracle
