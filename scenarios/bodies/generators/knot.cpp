#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "engine/core/steady_math.hpp"
#include "scenarios/bodies/generators/bodies.hpp"

namespace lrb::generators {
namespace {

/// The middle line of a torus knot, by t in [0, 1).
struct KnotLine {
  double p, q, radius, swing;
  Eigen::Vector3d operator()(double t) const {
    const double u = 2 * std::numbers::pi * t;
    const double r = radius * (1 + swing * steady::cos(q * u));
    return {r * steady::cos(p * u), r * steady::sin(p * u), radius * swing * steady::sin(q * u)};
  }
};

}  // namespace

Mesh knot(const GeneratorValues& v, std::uint64_t) {
  const KnotLine line{v.at("p"), v.at("q"), v.at("radius"), v.at("swing")};
  const int n = static_cast<int>(v.at("segments")), sides = static_cast<int>(v.at("sides"));
  const double tube = v.at("tube") * line.radius;

  // Frames are carried along without twist, then turned evenly so that the last meets the first.
  std::vector<Eigen::Vector3d> tangent(n), side(n + 1);
  for (int i = 0; i < n; ++i) tangent[i] = (line((i + 0.5) / n) - line((i - 0.5) / n)).normalized();
  side[0] = tangent[0].unitOrthogonal();
  for (int i = 0; i < n; ++i) side[i + 1] = steady::turn_between(tangent[i], tangent[(i + 1) % n]) * side[i];
  const double gap = steady::atan2(side[n].cross(side[0]).dot(tangent[0]), side[n].dot(side[0]));

  Mesh mesh;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d s = steady::rotation(tangent[i], gap * i / n) * side[i];
    const Eigen::Vector3d w = tangent[i].cross(s);
    for (int j = 0; j < sides; ++j) {
      const double angle = 2 * std::numbers::pi * j / sides;
      mesh.vertices.push_back(line(static_cast<double>(i) / n) +
                              tube * (steady::cos(angle) * s + steady::sin(angle) * w));
    }
  }
  const auto id = [&](int i, int j) { return static_cast<VertexId>((i % n) * sides + j % sides); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < sides; ++j) {
      add_triangle(mesh, id(i, j), id(i + 1, j + 1), id(i + 1, j));
      add_triangle(mesh, id(i, j), id(i, j + 1), id(i + 1, j + 1));
    }
  }
  return mesh;
}

}  // namespace lrb::generators
