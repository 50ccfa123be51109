// Signed distances of points, against rational brute force and winding numbers by solid angles.
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/answer_content.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/rational.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/world_box.hpp>

using namespace lrb;
using Eigen::Vector3d;
using oracle::Rational;
using shapes::RandomEngine;

namespace {

using test::closed, test::content;

/// The number of times that a closed surface winds around a point beside it.
double winding(const std::vector<test::Points>& simplices, const Vector3d& p) {
  double sum = 0;
  for (const test::Points& s : simplices) {
    const Vector3d a = s[0] - p, b = s[1] - p;
    if (s.size() == 2) {
      sum += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)) / (2 * std::numbers::pi);
      continue;
    }
    // Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983.
    const Vector3d c = s[2] - p;
    const double l = a.norm(), m = b.norm(), n = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), l * m * n + a.dot(b) * n + b.dot(c) * l + c.dot(a) * m) /
           (2 * std::numbers::pi);
  }
  return sum;
}

struct Seen {
  int points = 0, inside = 0, outside = 0, on_surface = 0;
};

void check(const LrbRep& rep, const Pose& pose, const std::vector<Vector3d>& points, Seen& seen) {
  const std::vector<test::Points> simplices = test::real_simplices(rep, pose);
  const double size = world_box(rep, pose).diagonal().norm();
  const std::vector<PointDistance> found = point_distances(rep, pose, points);
  REQUIRE(found.size() == points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vector3d p = points[i];
    if (rep.dim() == 2) p.z() = 0;
    CAPTURE(p);
    const PointDistance& d = found[i];
    const Rational truth = test::surface_distance_sq({test::Points{p}}, simplices);
    REQUIRE(oracle::square(d.lower) <= truth);
    REQUIRE(truth <= oracle::square(d.upper));
    REQUIRE(d.upper - d.lower <= 1e-12 * size + 2.3e-13 * d.upper + 1e-15 * d.upper);
    REQUIRE((d.upper == 0) == (truth == 0));
    REQUIRE((d.side == Where::on_surface) == (truth == 0));
    REQUIRE(rep.face_of_simplex(d.closest.simplex) == d.closest.face);
    REQUIRE(std::abs((d.closest.point - p).norm() - d.upper) <= 1e-9 * (size + p.norm()));
    ++seen.points;
    seen.on_surface += d.side == Where::on_surface;
    if (truth == 0) continue;
    if (!rep.closed()) {
      REQUIRE_FALSE(d.side);
      REQUIRE(d.signed_lower() == d.lower);
      continue;
    }
    REQUIRE(d.side);
    (d.side == Where::inside ? seen.inside : seen.outside) += 1;
    REQUIRE(d.signed_upper() == (d.side == Where::inside ? -d.lower : d.upper));
    // Solid angles are ill-conditioned next to the surface.
    if (d.lower < 1e-6 * size || d.upper > 1e3 * size) continue;
    const double turns = winding(simplices, p);
    REQUIRE(std::abs(turns - std::round(turns)) < 1e-3);
    REQUIRE((d.side == Where::inside) == (std::lround(turns) % 2 != 0));
  }
}

/// Points in and around a body, on it, within rounding of it, and far away.
std::vector<Vector3d> points_about(const LrbRep& rep, const Pose& pose, RandomEngine& random, int count) {
  std::vector<Vector3d> out;
  const std::vector<test::Points> simplices = test::real_simplices(rep, pose);
  for (int i = 0; i < count; ++i) {
    const test::Points& s = simplices[random() % simplices.size()];
    Vector3d p = test::random_point_of(random, s);
    Vector3d way = shapes::random_direction(random);
    if (rep.dim() == 2) way.z() = 0;
    switch (i % 6) {
      case 0:
        p = s[0];  // a vertex
        break;
      case 1:
        p = (s[0] + s[1]) / 2;
        break;
      case 2:
        p += way * std::ldexp(1.0, -static_cast<int>(random() % 60));
        break;
      case 3:
        p += 1e6 * way;
        break;
      default:
        p += way * shapes::uniform(random);
    }
    out.push_back(p);
  }
  return out;
}

/// Points of half a grid beside triangles and segments on the grid: many are on a face, or equally far from
/// several.
Seen check_points_by_grids(int bodies) {
  RandomEngine random(5);
  Seen seen;
  for (int i = 0; i < bodies; ++i) {
    CAPTURE(i);
    const LrbRep body = test::open_body(test::grid_soup(random, 4, i % 4 == 0 ? 2 : 3));
    std::vector<Vector3d> points;
    for (int k = 0; k < 10; ++k) {
      const auto coordinate = [&] { return std::floor(shapes::uniform(random, -2, 10)) / 2; };
      const double x = coordinate(), y = coordinate();
      points.push_back({x, y, coordinate()});
    }
    check(body, {}, points, seen);
  }
  return seen;
}

/// Points about solids and other bodies, in `rounds` poses each.
void check_points_by_bodies(int rounds) {
  RandomEngine random(1);
  // Two boxes that overlap: their common part counts as outside.
  const Mesh two =
      shapes::several({shapes::quad_box(), shapes::translated(shapes::quad_box(), {0.5, 0.25, 0.125})});
  const LrbRep bodies[] = {closed(shapes::quad_box()),
                           closed(shapes::tetrahedron(1)),
                           closed(shapes::icosphere(1)),
                           closed(shapes::torus(8, 6)),
                           closed(shapes::bowl(6, 3)),
                           LrbRep::without_regions(two, true, true),
                           test::open_body(shapes::open_cylinder(8)),
                           closed(shapes::gear(8)),
                           closed(shapes::ring_2d(12)),
                           closed(shapes::star(5))};
  Seen seen;
  for (const LrbRep& body : bodies)
    for (int round = 0; round < rounds; ++round) {
      CAPTURE(body.real_face_count());
      Pose pose;
      if (round > 0)
        pose = body.dim() == 2 ? Pose::rotation(Vector3d(0, 0, 1), 1.0 * round, {0.3, -1.5, 0})
                               : Pose{shapes::random_rotation(random), {0.3, -1.5, 1000.0 * (round % 3 - 1)}};
      check(body, pose, points_about(body, pose, random, 60), seen);
    }
  CHECK(seen.points == 600 * rounds);
  CHECK(seen.inside > 50 * rounds);
  CHECK(seen.outside > 200 * rounds);
  CHECK(seen.on_surface > 30 * rounds);
}

}  // namespace

TEST_CASE("signed distances of points agree with rational brute force and with winding numbers") {
  check_points_by_bodies(3);
}

TEST_CASE("signed distances of 208,000 points, to triangles on a grid and to bodies" *
          doctest::test_suite("long")) {
  CHECK(check_points_by_grids(10'000).on_surface > 2000);
  check_points_by_bodies(180);
}

TEST_CASE("signed distances of points to triangles on a grid") {
  CHECK(check_points_by_grids(100).on_surface > 20);
}

TEST_CASE("a tolerance widens the interval of a signed distance") {
  const LrbRep ball = closed(shapes::icosphere(3));
  const std::vector<Vector3d> points = {{0, 0, 0.5}};
  PointDistanceRequest request;
  request.tolerance = 0.1;
  request.side = false;
  const PointDistance d = point_distances(ball, {}, points, request)[0];
  CHECK(d.lower <= 0.5);
  CHECK(d.upper >= 0.48);
  CHECK(d.upper - d.lower <= 0.1);
  CHECK_FALSE(d.side);
}

TEST_CASE("signed distances to a body without faces are infinite") {
  const LrbRep nothing = test::open_body(Mesh{});
  const std::vector<Vector3d> points = {{0, 0, 0.5}};
  const PointDistance d = point_distances(nothing, {}, points)[0];
  CHECK(std::isinf(d.lower));
  CHECK_FALSE(d.side);
  CHECK(d.closest.simplex == kNull);
  CHECK(point_distances(nothing, {}, {}).empty());
}

TEST_CASE("distances of points do not depend on threads or on the other points") {
  const LrbRep body = closed(shapes::bumpy_sphere(3, 1));
  RandomEngine random(12);
  std::vector<Vector3d> points;
  for (int i = 0; i < 300; ++i)
    points.push_back(shapes::uniform(random, 0, 2) * shapes::random_direction(random));
  const auto one = content(point_distances(body, {}, points, {}, 1));
  CHECK((content(point_distances(body, {}, points, {}, 4)) == one));
  for (std::size_t i = 0; i < points.size(); i += 7)
    CHECK((content(point_distances(body, {}, std::span(points).subspan(i, 1))[0]) == one[i]));
  points[1].y() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(point_distances(body, {}, points),
                       "point 1: expected finite coordinates, found a NaN or an infinity", InputError);
  CHECK_THROWS_AS(point_distances(body, {}, {}, {.tolerance = -1}), InputError);
}
