#include <map>
#include <random>

#include <doctest/doctest.h>

#include "engine/build/closing.hpp"
#include "engine/build/convex_hull.hpp"
#include "engine/build/convex_polygon.hpp"
#include "engine/exact/predicates.hpp"
#include "scenarios/shapes/shapes.hpp"

namespace lrb {
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

void check_closed(const Mesh& mesh) {
  std::map<std::pair<VertexId, VertexId>, int> balance;
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    for (int i = 0; i < 3; ++i) {
      const VertexId a = mesh.face(f)[i], b = mesh.face(f)[(i + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  for (const auto& [edge, sum] : balance) CHECK(sum == 0);
}

TEST_CASE("the convex hull is closed and leaves no point in front of a face") {
  for (int round = 0; round < 20; ++round) {
    const auto points = random_points(20 + 20 * round, round, {1, 1, round % 2 ? 1e-6 : 1});
    const Mesh hull = convex_hull_mesh(points);
    check_closed(hull);
    CHECK(hull.face_count() == 2 * hull.vertices.size() - 4);
    for (FaceId f = 0; f < hull.face_count(); ++f) {
      const auto at = [&](int i) { return hull.vertices[hull.face(f)[i]].data(); };
      for (const Vector3& p : points) REQUIRE(exact::orient3d(at(0), at(1), at(2), p.data()) <= 0);
    }
  }
}

TEST_CASE("there is no convex hull of points in a plane") {
  CHECK(convex_hull(random_points(30, 1, {1, 1, 0})).empty());
  CHECK(convex_hull(random_points(30, 1, {1, 0, 0})).empty());
  CHECK(convex_hull(random_points(3, 1, {1, 1, 1})).empty());
}

TEST_CASE(
    "the outermost polytope is closed, has few faces, holds all points and is not much larger than their "
    "hull") {
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
    const Mesh polytope = enclosing_polytope(c.mesh.vertices, 20, 0.005);
    REQUIRE(polytope.face_count() > 0);
    CHECK(polytope.face_count() <= 20);
    check_closed(polytope);
    for (const Vector3& p : c.mesh.vertices) REQUIRE(holds(polytope, p));
    CHECK(volume_of(polytope) <= c.ratio * volume_of(convex_hull_mesh(c.mesh.vertices)));
  }
}

TEST_CASE("the outermost polytope of flat sets, single points and huge coordinates") {
  for (const Vector3& scale : {Vector3(1, 1, 0), Vector3(1, 0, 0)}) {
    const auto points = random_points(50, 2, scale);
    const Mesh polytope = enclosing_polytope(points, 20, 0.005);
    REQUIRE(polytope.face_count() > 0);
    for (const Vector3& p : points) CHECK(holds(polytope, p));
  }
  CHECK(enclosing_polytope(random_points(50, 2, {1e200, 1e200, 1e200}), 20, 0.005).face_count() == 0);
}

TEST_CASE("the convex outline keeps points in the middle of its sides and turns left") {
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
  CHECK(convex_outline(random_points(10, 1, {1, 0, 0})).size() < 3);
}

TEST_CASE("the outermost polygon has few sides and holds all points") {
  for (const Mesh& mesh : {shapes::circle(100), shapes::star(9), shapes::comb_2d(5)}) {
    const auto polygon = enclosing_polygon(mesh.vertices, 8, 0.005);
    CHECK(polygon.size() >= 3);
    CHECK(polygon.size() <= 8);
    for (const Vector3& p : mesh.vertices) REQUIRE(holds_2d(polygon, p));
  }
}

}  // namespace
}  // namespace lrb
