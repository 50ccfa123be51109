#pragma once

#include <cmath>
#include <numbers>

#include "scenarios/bodies/shapes.hpp"

namespace lrb::test {

/// A tube that crosses itself all the way round: an 8, turned about the z axis.
inline Mesh figure_eight() {
  Mesh m = shapes::torus(24, 16);
  const auto angle = [](std::size_t i, std::size_t n) {
    return 2 * std::numbers::pi * double(i) / double(n);
  };
  for (std::size_t i = 0; i < m.vertices.size(); ++i) {
    const double u = angle(i / 16, 24), v = angle(i % 16, 16), r = 2 + std::sin(v);
    m.vertices[i] = {r * std::cos(u), r * std::sin(u), 0.6 * std::sin(2 * v)};
  }
  return m;
}

}  // namespace lrb::test
