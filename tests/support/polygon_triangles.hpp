#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "engine/exact/predicates.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::test {

/// Triangles of one orientation whose sides sum up to the outline of a polygon cover each point as often as
/// the outline winds around it, and have its area. Returns what is wrong with those of cut_polygon(), or
/// null.
inline const char* fault_of_triangles(const std::vector<Eigen::Vector3d>& x) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const PolygonCut cut = cut_polygon(x, triangles);
  if (triangles.size() + 2 != x.size()) return "a polygon has another number of triangles";
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  const auto add = [&](std::uint32_t i, std::uint32_t j, int by) {
    sides[std::minmax(i, j)] += i < j ? by : -by;
  };
  const auto n = static_cast<std::uint32_t>(x.size());
  for (std::uint32_t i = 0; i < n; ++i) add(i, (i + 1) % n, 1);
  std::array<bool, 3> left{}, right{};  // of the triangles, in the projection along each axis
  for (const auto& t : triangles)
    for (std::uint32_t k = 0; k < 3; ++k) {
      add(t[k], t[(k + 1) % 3], -1);
      const int axis = static_cast<int>(k);
      const int turn =
          exact::orient_axes(x[t[0]].data(), x[t[1]].data(), x[t[2]].data(), axis, (axis + 1) % 3);
      left[k] |= turn > 0, right[k] |= turn < 0;
    }
  for (const auto& [side, sum] : sides)
    if (sum != 0) return "triangles do not end at the sides of their polygon";
  if (cut == PolygonCut::folded || left == std::array<bool, 3>{} || left[0] != right[0] ||
      left[1] != right[1] || left[2] != right[2])
    return nullptr;
  return "triangles that cover a polygon have two orientations";
}

}  // namespace lrb::test
