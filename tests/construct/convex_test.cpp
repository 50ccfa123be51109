#include <random>
#include <set>

#include <doctest/doctest.h>

#include "engine/construct/closing.hpp"
#include "engine/construct/convex_hull.hpp"
#include "engine/exact/predicates.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/mesh_check.hpp>

namespace lrb::construct {
namespace {

using Vector3 = Eigen::Vector3d;

std::vector<Vector3> random_points(int count, std::uint64_t seed, const Vector3& scale) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(scale.x() * normal(random), scale.y() * normal(random), scale.z() * normal(random));
  return points;
}

TEST_CASE("the convex hull is closed and no point is in front of a face") {
  for (int round = 0; round < 20; ++round) {
    const auto points = random_points(20 + 20 * round, round, {1, 1, round % 2 ? 1e-6 : 1});
    const Mesh hull = convex_hull_mesh(points);
    CHECK(check_mesh(hull, false).closed);
    CHECK(hull.face_count() == 2 * hull.vertices.size() - 4);
    for (FaceId f = 0; f < hull.face_count(); ++f) {
      const auto at = [&](int i) { return hull.vertices[hull.face(f)[i]].data(); };
      for (const Vector3& p : points) REQUIRE(exact::orient3d(at(0), at(1), at(2), p.data()) <= 0);
    }
  }
}

/// Points added in order, each in place of all triangles that it is strictly in front of.
std::vector<std::array<std::uint32_t, 3>> hull_point_by_point(const std::vector<Vector3>& points) {
  using Triangle = std::array<std::uint32_t, 3>;
  const auto at = [&](std::uint32_t p) { return points[p].data(); };
  const auto count = static_cast<std::uint32_t>(points.size());
  std::uint32_t b = 1, c, d;
  while (b < count && points[b] == points[0]) ++b;
  for (c = b + 1; c < count && exact::collinear3d(at(0), at(b), at(c));) ++c;
  for (d = c + 1; d < count && exact::orient3d(at(0), at(b), at(c), at(d)) == 0;) ++d;
  if (d >= count) return {};
  if (exact::orient3d(at(0), at(b), at(c), at(d)) > 0) std::swap(b, c);
  std::vector<Triangle> hull = {{0, b, c}, {0, d, b}, {b, d, c}, {c, d, 0}};
  for (std::uint32_t p = 0; p < count; ++p) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::erase_if(hull, [&](const Triangle& t) {
      if (exact::orient3d(at(t[0]), at(t[1]), at(t[2]), at(p)) <= 0) return false;
      for (int k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
      return true;
    });
    for (const auto& [u, v] : edges)
      if (!edges.contains({v, u})) hull.push_back({u, v, p});
  }
  return hull;
}

TEST_CASE("the convex hull equals incremental insertion, triangle for triangle") {
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    auto cloud = random_points(30 + 10 * round, round, {1, 1, 1});
    CHECK(convex_hull(cloud) == hull_point_by_point(cloud));
    for (Vector3& p : cloud) p.normalize();
    CHECK(convex_hull(cloud) == hull_point_by_point(cloud));
  }
}

TEST_CASE("the convex hull of coplanar, collinear and coincident points") {
  std::mt19937_64 random(3);
  for (int round = 0; round < 600; ++round) {
    CAPTURE(round);
    const std::uint64_t steps = 2 + round % 5;  // few steps: nearly all points are degenerate
    std::vector<Vector3> grid;
    for (int i = 0; i < 8 + round / 4; ++i) {
      Vector3 p;
      for (int k = 0; k < 3; ++k) p[k] = static_cast<double>(random() % steps) * (k == 0 ? 0.1 : 1);
      grid.push_back(p);
    }
    REQUIRE(convex_hull(grid) == hull_point_by_point(grid));
  }
}

TEST_CASE("the convex hull of a fine ball takes memory linear in its size") {
  // Point by point this would be 1.7e9 signs.
  const Mesh ball = shapes::icosphere(6);
  CHECK(convex_hull(ball.vertices).size() == 2 * ball.vertices.size() - 4);
}

TEST_CASE("coplanar points have no convex hull") {
  CHECK(convex_hull(random_points(30, 1, {1, 1, 0})).empty());
  CHECK(convex_hull(random_points(30, 1, {1, 0, 0})).empty());
  CHECK(convex_hull(random_points(3, 1, {1, 1, 1})).empty());
}

TEST_CASE(
    "the outermost polytope is closed, has few faces, contains all points and is little larger than their convex hull") {
  struct {
    Mesh mesh;
    double ratio;  // a measured bound
  } cases[] = {{shapes::icosphere(4), 1.4},
               {shapes::bumpy_sphere(4, 3, 0.4), 1.5},
               {shapes::scaled(shapes::torus(40, 20), 1e6), 1.4},
               {shapes::box(), 1.4},
               {shapes::box({0, 0, 0}, {1, 1, 1e-4}), 1e3}};
  for (const auto& c : cases) {
    CAPTURE(c.mesh.name);
    Workers workers(2);
    const Mesh polytope = enclosing_polytope(c.mesh.vertices, 20, 0.005, workers);
    REQUIRE(polytope.face_count() > 0);
    CHECK(polytope.face_count() <= 20);
    CHECK(check_mesh(polytope, false).closed);
    for (const Vector3& p : c.mesh.vertices) REQUIRE(holds(polytope, p));
    CHECK(volume_of(polytope) <= c.ratio * volume_of(convex_hull_mesh(c.mesh.vertices)));
  }
}

TEST_CASE("the outermost polytope of flat sets, single points and huge coordinates") {
  Workers workers;
  for (const Vector3& scale : {Vector3(1, 1, 0), Vector3(1, 0, 0)}) {
    const auto points = random_points(50, 2, scale);
    const Mesh polytope = enclosing_polytope(points, 20, 0.005, workers);
    REQUIRE(polytope.face_count() > 0);
    for (const Vector3& p : points) CHECK(holds(polytope, p));
  }
  CHECK(enclosing_polytope(random_points(50, 2, {1e200, 1e200, 1e200}), 20, 0.005, workers).face_count() ==
        0);
}

TEST_CASE("the convex outline is counter-clockwise and keeps points on its sides") {
  const std::vector<Vector3> points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0},
                                       {1, 2, 0}, {0, 2, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 0}};
  const auto outline = convex_outline(points);
  CHECK(outline == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7});
  for (int round = 0; round < 20; ++round) {
    const auto cloud = random_points(3 + 10 * round, round, {1, 1, 0});
    const auto corners = convex_outline(cloud);
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (const Vector3& p : cloud)
        REQUIRE(exact::orient2d(cloud[corners[i]].data(), cloud[corners[(i + 1) % corners.size()]].data(),
                                p.data()) >= 0);
  }
  CHECK(convex_outline(random_points(10, 1, {1, 0, 0})).empty());
}

TEST_CASE("the outermost polygon has few sides and contains all points") {
  for (const Mesh& mesh : {shapes::circle(100), shapes::star(9), shapes::comb_2d(5)}) {
    const auto polygon = enclosing_polygon(mesh.vertices, 8, 0.005);
    CHECK(polygon.size() >= 3);
    CHECK(polygon.size() <= 8);
    for (const Vector3& p : mesh.vertices) REQUIRE(holds_2d(polygon, p));
  }
}

}  // namespace
}  // namespace lrb::construct
