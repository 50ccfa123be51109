#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "engine/construct/cap_gauge.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"

namespace lrb::construct {
namespace {

using Vector3 = Eigen::Vector3d;

/// Twelve triangles that are off the body by themselves; the last one has no area.
struct Floor {
  FrontMesh front{Mesh()};
  Patch patch;

  explicit Floor(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> off(0, 0.3);
    for (FrontMesh::Slot s = 0; s < 12; ++s) {
      const Vector3 x(normal(random), normal(random), normal(random));
      FrontMesh::Triangle t{{}, {s, s, s}, FaceId(s), 0, off(random)};
      for (int i = 0; i < 3; ++i) {
        const Vector3 away(normal(random), normal(random), normal(random));
        const Vector3 along = i * Vector3::UnitX();
        t.v[i] = front.add_point(x + (s < 11 ? away : along), VertexId(3 * s + i), off(random));
      }
      front.add(s, t);
      patch.slots.push_back(s);
    }
  }

  double off_by(FrontMesh::Slot s, const Vector3& q) const {
    const auto& t = front[s];
    const SimplexPoint near = nearest_on_triangle(q, front.x(t.v[0]), front.x(t.v[1]), front.x(t.v[2]));
    double off = std::sqrt(near.distance_sq) + t.excess_deviation;
    for (int i = 0; i < 3; ++i) off += near.weight[i] * front.point(t.v[i]).off;
    return off;
  }
};

TEST_CASE("the deviation of a point from a floor equals brute force over its triangles") {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  constexpr double kMax = 0.8;
  int within = 0, beyond = 0;
  for (int round = 0; round < 200; ++round) {
    const Floor floor(random);
    PatchFloor tested;
    tested.load(floor.front, floor.patch, kMax);
    for (int i = 0; i < 20; ++i) {
      const Vector3 q(normal(random), normal(random), normal(random));
      double least = std::numeric_limits<double>::infinity();
      for (const FrontMesh::Slot s : floor.patch.slots) least = std::min(least, floor.off_by(s, q));
      CAPTURE(round);
      CHECK(tested.off(q) == doctest::Approx(least));
      int first = i % 12;
      CHECK(tested.is_within(q, first) == (least <= kMax));
      if (least <= kMax) CHECK(floor.off_by(static_cast<FrontMesh::Slot>(first), q) <= kMax + 1e-12);
      (least <= kMax ? within : beyond) += 1;
    }
  }
  CHECK(within > 500);
  CHECK(beyond > 500);
}

}  // namespace
}  // namespace lrb::construct
