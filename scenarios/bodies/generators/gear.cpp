#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/steady_math.hpp"
#include "scenarios/bodies/generators/bodies.hpp"

namespace lrb::generators {
namespace {

/// Returns the distance of a gear's outline from its axis, at a fraction of a tooth's pitch: steep flanks,
/// flat tops and feet.
double tooth_radius(double pitch_fraction, double depth) {
  const double s = steady::cos(2 * std::numbers::pi * pitch_fraction);
  return 1 + 0.5 * depth * std::clamp(2.2 * s, -1.0, 1.0);
}

std::vector<Eigen::Vector2d> outline(const GeneratorValues& v) {
  const int teeth = static_cast<int>(v.at("teeth")), points = static_cast<int>(v.at("points"));
  std::vector<Eigen::Vector2d> out;
  for (int i = 0; i < teeth * points; ++i) {
    const double angle = 2 * std::numbers::pi * i / (teeth * points);
    const double r = v.at("radius") * tooth_radius((i % points + 0.5) / points, v.at("depth"));
    out.emplace_back(r * steady::cos(angle), r * steady::sin(angle));
  }
  return out;
}

}  // namespace

/// Makes a tube of rectangular section around the axis: a loop of rings (bore, top, teeth, bottom), each with
/// one point for each point of the outline. It is star-shaped seen from the axis, so that it cannot meet
/// itself.
Mesh gear(const GeneratorValues& v, std::uint64_t) {
  const std::vector<Eigen::Vector2d> teeth = outline(v);
  const int n = static_cast<int>(teeth.size()), rings = static_cast<int>(v.at("rings"));
  const double bore = v.at("bore") * v.at("radius"), half = v.at("thickness") * v.at("radius") / 2;
  const int deep = std::max(1, rings / 2);  // rows of faces across the thickness

  std::vector<std::pair<double, double>> loop;  // (fraction from bore to teeth, height)
  for (int i = 0; i < rings; ++i) loop.emplace_back(1.0 * i / rings, -half);
  for (int i = 0; i < deep; ++i) loop.emplace_back(1, -half + 2 * half * i / deep);
  for (int i = 0; i < rings; ++i) loop.emplace_back(1 - 1.0 * i / rings, half);
  for (int i = 0; i < deep; ++i) loop.emplace_back(0, half - 2 * half * i / deep);

  Mesh mesh;
  for (const auto& [out, z] : loop) {
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector2d inner = bore * teeth[i].normalized();
      const Eigen::Vector2d p = inner + out * (teeth[i] - inner);
      mesh.vertices.emplace_back(p.x(), p.y(), z);
    }
  }
  const int rows = static_cast<int>(loop.size());
  const auto id = [&](int row, int i) { return static_cast<VertexId>((row % rows) * n + i % n); };
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < n; ++i) {
      add_triangle(mesh, id(row, i), id(row, i + 1), id(row + 1, i + 1));
      add_triangle(mesh, id(row, i), id(row + 1, i + 1), id(row + 1, i));
    }
  }
  return mesh;
}

Mesh cog2d(const GeneratorValues& v, std::uint64_t) {
  return polygon_2d(outline(v));
}

}  // namespace lrb::generators
