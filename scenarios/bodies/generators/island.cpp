#include <cmath>
#include <numbers>

#include "engine/core/random.hpp"
#include "engine/core/steady_math.hpp"
#include "scenarios/bodies/generators/bodies.hpp"

namespace lrb::generators {
namespace {

/// Gives each edge a bay in its middle third, as in a Koch curve turned inside out. The bay's apex is moved a
/// little, so that no two look alike. Depths below a third of an edge keep bays within the triangle that
/// belongs to their edge.
std::vector<Eigen::Vector2d> with_bays(const std::vector<Eigen::Vector2d>& outline, double depth,
                                       Random& random) {
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d a = outline[i], b = outline[(i + 1) % outline.size()], along = b - a;
    const Eigen::Vector2d inward(-along.y(), along.x());  // the solid is on the left
    out.push_back(a);
    out.push_back(a + along * random.in(0.30, 0.38));
    // Drawn one after the other, because compilers evaluate operands in different orders.
    const double reach = random.in(0.7, 1.0), middle = random.in(0.44, 0.56);
    out.push_back(a + along * middle + inward * depth * reach);
    out.push_back(a + along * random.in(0.62, 0.70));
  }
  return out;
}

}  // namespace

Mesh polygon_2d(const std::vector<Eigen::Vector2d>& outline) {
  Mesh mesh;
  mesh.dim = 2;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (VertexId i = 0; i < n; ++i) {
    mesh.vertices.emplace_back(outline[i].x(), outline[i].y(), 0);
    const VertexId corners[2] = {i, VertexId((i + 1) % n)};
    mesh.add_face(corners);
  }
  return mesh;
}

Mesh island(const GeneratorValues& v, std::uint64_t seed) {
  Random random(seed);
  // The coarse outline: wide capes and one deep gulf, so that it is not convex even before detail is cut into
  // it.
  const double cape[][2] = {{1.00, 0.04}, {0.93, 0.10}, {0.98, 0.24}, {0.90, 0.37}, {0.38, 0.47},
                            {0.95, 0.58}, {1.00, 0.70}, {0.45, 0.80}, {1.00, 0.91}};  // radius, turn
  std::vector<Eigen::Vector2d> outline;
  for (const auto& c : cape) {
    const double angle = 2 * std::numbers::pi * c[1];
    outline.emplace_back(v.at("radius") * c[0] * steady::cos(angle),
                         v.at("radius") * c[0] * steady::sin(angle));
  }
  for (int level = 0; level < static_cast<int>(v.at("levels")); ++level)
    outline = with_bays(outline, v.at("depth"), random);
  return polygon_2d(outline);
}

}  // namespace lrb::generators
