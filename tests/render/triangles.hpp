#pragma once
/// Draw lists made by hand.

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <lrbscope/render/draw_list.hpp>

namespace lrb::test {

using Triangles = std::vector<std::array<Eigen::Vector3d, 3>>;

/// A sphere of 20 * 4^levels triangles.
inline Triangles sphere_triangles(int levels, double radius = 1, const Eigen::Vector3d& centre = {0, 0, 0}) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::array<Eigen::Vector3d, 12> v = {{{-1, g, 0},
                                              {1, g, 0},
                                              {-1, -g, 0},
                                              {1, -g, 0},
                                              {0, -1, g},
                                              {0, 1, g},
                                              {0, -1, -g},
                                              {0, 1, -g},
                                              {g, 0, -1},
                                              {g, 0, 1},
                                              {-g, 0, -1},
                                              {-g, 0, 1}}};
  const int f[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  Triangles out;
  for (const auto& t : f) out.push_back({v[t[0]].normalized(), v[t[1]].normalized(), v[t[2]].normalized()});
  for (int level = 0; level < levels; ++level) {
    Triangles finer;
    for (const auto& [a, b, c] : out) {
      const Eigen::Vector3d ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    out = std::move(finer);
  }
  for (auto& t : out) {
    for (auto& x : t) x = centre + radius * x;
  }
  return out;
}

/// The twelve triangles of a box.
inline Triangles box_triangles(const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
  const auto at = [&](int i) {
    return Eigen::Vector3d((i & 1) ? hi.x() : lo.x(), (i & 2) ? hi.y() : lo.y(), (i & 4) ? hi.z() : lo.z());
  };
  Triangles out;
  for (const auto& q :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    out.push_back({at(q[0]), at(q[1]), at(q[2])});
    out.push_back({at(q[0]), at(q[2]), at(q[3])});
  }
  return out;
}

inline void add(render::DrawList& list, const Triangles& triangles, const render::DrawTriangle& like,
                std::uint32_t first_id = 0) {
  for (const auto& x : triangles) {
    render::DrawTriangle t = like;
    t.x = x;
    t.id = first_id++;
    list.triangles.push_back(t);
  }
}

}  // namespace lrb::test
