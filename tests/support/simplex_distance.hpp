#pragma once
/// Distances between points, segments and triangles, by the textbook and slowly: shares no code with the
/// engine.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::test {

using Points = std::vector<Eigen::Vector3d>;  // corners: 1, 2 or 3

inline Points simplex_points(const LrbRep& rep, const Pose& pose, SimplexId s) {
  VertexId v[3];
  rep.simplex(s, v);
  Points out;
  for (int k = 0; k < rep.simplex_size(); ++k) out.push_back(pose.apply(rep.vertices()[v[k]]));
  return out;
}

/// Returns the real simplices of a body in the world.
inline std::vector<Points> real_simplices(const LrbRep& rep, const Pose& pose) {
  std::vector<Points> out;
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) out.push_back(simplex_points(rep, pose, s));
  return out;
}

/// Returns the greatest distance from the first corner to another.
inline double reach(const Points& s) {
  double most = 0;
  for (const Eigen::Vector3d& x : s) most = std::max(most, (x - s[0]).norm());
  return most;
}

/// Returns the corners as the exact predicates take them.
inline std::array<const double*, 3> pointers(const Points& corners) {
  std::array<const double*, 3> out{};
  for (std::size_t k = 0; k < corners.size(); ++k) out[k] = corners[k].data();
  return out;
}

inline exact::Meet meet_of(const Points& s, const Points& t) {
  return s.size() == 3 ? exact::meet_triangles(pointers(s).data(), pointers(t).data())
                       : exact::meet_segments(pointers(s).data(), pointers(t).data());
}

inline double point_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  const double s = d.squaredNorm() > 0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (a + s * d - p).norm();
}

/// By golden section: the distance from a point that runs along one segment is convex.
inline double segment_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                              const Eigen::Vector3d& d) {
  double low = 0, high = 1;
  const auto at = [&](double s) { return point_segment(a + s * (b - a), c, d); };
  for (int i = 0; i < 60; ++i) {
    const double x = low + 0.382 * (high - low), y = low + 0.618 * (high - low);
    if (at(x) < at(y)) {
      high = y;
    } else {
      low = x;
    }
  }
  return at((low + high) / 2);
}

inline double point_triangle(const Eigen::Vector3d& p, const Points& t) {
  const Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  bool over = n.norm() > 0;
  for (int k = 0; k < 3 && over; ++k) over = n.dot((t[(k + 1) % 3] - t[k]).cross(p - t[k])) >= 0;
  if (over) return std::abs(n.dot(p - t[0])) / n.norm();
  return std::min({point_segment(p, t[0], t[1]), point_segment(p, t[1], t[2]), point_segment(p, t[2], t[0])});
}

/// Of simplices that do not pass through each other.
inline double simplex_distance(const Points& s, const Points& t) {
  double least = INFINITY;
  const auto corners_to = [&least](const Points& from, const Points& to) {
    for (const Eigen::Vector3d& p : from)
      least = std::min(least, to.size() == 3   ? point_triangle(p, to)
                              : to.size() == 2 ? point_segment(p, to[0], to[1])
                                               : (p - to[0]).norm());
  };
  corners_to(s, t);
  corners_to(t, s);
  if (s.size() == 3 && t.size() == 3)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        least = std::min(least, segment_segment(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
  return least;
}

/// Of surfaces that do not pass through each other. Only pairs whose balls are closer than the current
/// distance are measured.
inline double surface_distance(const std::vector<Points>& a, const std::vector<Points>& b) {
  struct Ball {
    Eigen::Vector3d centre;
    double radius;
  };
  const auto ball_of = [](const Points& s) {
    Ball ball{Eigen::Vector3d::Zero(), 0};
    for (const Eigen::Vector3d& x : s) ball.centre += x / static_cast<double>(s.size());
    for (const Eigen::Vector3d& x : s) ball.radius = std::max(ball.radius, (x - ball.centre).norm());
    return ball;
  };
  std::vector<Ball> balls;
  balls.reserve(b.size());
  for (const Points& t : b) balls.push_back(ball_of(t));
  double least = INFINITY;
  for (const Points& s : a) {
    const Ball ball = ball_of(s);
    for (std::size_t j = 0; j < b.size(); ++j)
      if ((ball.centre - balls[j].centre).norm() - ball.radius - balls[j].radius < least)
        least = std::min(least, simplex_distance(s, b[j]));
  }
  return least;
}

inline Eigen::Vector3d random_point_of(shapes::RandomEngine& random, const Points& s) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0;
  for (const Eigen::Vector3d& x : s) {
    const double w = shapes::uniform(random);
    sum += w * x;
    weights += w;
  }
  return sum / weights;
}

}  // namespace lrb::test
