#include "engine/mesh/polygon_shape.hpp"

#include <map>
#include <random>

#include <doctest/doctest.h>

#include "engine/exact/predicates.hpp"
#include "scenarios/bodies/shapes.hpp"

namespace lrb::test {

using namespace shapes;

TEST_CASE("a convex polygon with collinear corners is split into triangles with area") {
  const std::vector<std::vector<Point2>> shapes = {{{0, 0}, {840, 0}, {0, 840}},
                                                   {{0, 0}, {840, 0}, {840, 840}, {0, 840}},
                                                   {{0, 0}, {840, 0}, {1680, 840}, {840, 1680}, {0, 840}}};
  std::mt19937_64 random(3);
  for (int round = 0; round < 600; ++round) {
    const auto& shape = shapes[random() % shapes.size()];
    std::vector<Point2> corners;
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const int parts = static_cast<int>(1 + random() % 4);  // 840 divides by 1, 2, 3 and 4
      for (int k = 0; k < parts; ++k)
        corners.push_back(shape[i] + (shape[(i + 1) % shape.size()] - shape[i]) * k / parts);
    }
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(random() % corners.size()),
                corners.end());
    const Mesh points = polygon(corners);
    std::vector<VertexId> face(corners.size());
    for (VertexId v = 0; v < face.size(); ++v) face[v] = v;

    std::vector<std::array<VertexId, 3>> triangles;
    triangulate_convex(points, face, triangles);
    CHECK(triangles.size() == face.size() - 2);
    std::map<std::pair<VertexId, VertexId>, int> sides;  // times run along, less times run back
    for (const auto& t : triangles) {
      CHECK(exact::orient2d(corners[t[0]].data(), corners[t[1]].data(), corners[t[2]].data()) == 1);
      for (int i = 0; i < 3; ++i) {
        ++sides[{t[i], t[(i + 1) % 3]}];
        --sides[{t[(i + 1) % 3], t[i]}];
      }
    }
    for (const auto& [side, count] : sides) {
      const bool along = (side.first + 1) % face.size() == side.second;
      const bool back = (side.second + 1) % face.size() == side.first;
      CHECK(count == along - back);
    }
  }
}

}  // namespace lrb::test
