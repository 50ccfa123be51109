#include <map>
#include <optional>
#include <random>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "render/screen_mesh.hpp"

using namespace lrb;
using Eigen::Vector3d;

namespace {

render::EyePolygon triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, std::uint32_t source) {
  return {{a, b, c}, (b - a).cross(c - a), source};
}

/// Where the line from p along d meets the polygon, if well inside it.
std::optional<double> hit(const render::EyePolygon& polygon, const Vector3d& p, const Vector3d& d) {
  const double slope = polygon.normal.dot(d);
  if (slope == 0) return std::nullopt;
  const double t = polygon.normal.dot(polygon.x[0] - p) / slope;
  const Vector3d x = p + t * d;
  for (std::size_t i = 0; i < polygon.x.size(); ++i) {
    const Vector3d &a = polygon.x[i], &b = polygon.x[(i + 1) % polygon.x.size()];
    if (polygon.normal.dot((b - a).cross(x - a)) < 1e-7 * polygon.normal.norm()) return std::nullopt;
  }
  return t;
}

void check_order(const std::vector<render::EyePolygon>& input, bool orthographic, std::mt19937& random) {
  const auto sorted = render::back_to_front(input, orthographic);
  std::uniform_real_distribution<double> u(-3, 3);
  int rays = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = orthographic ? Vector3d(u(random), u(random), 0) : Vector3d::Zero();
    const Vector3d d = orthographic ? Vector3d(0, 0, 1) : Vector3d(u(random), u(random), 8);
    double before = std::numeric_limits<double>::infinity();
    std::map<std::uint32_t, int> hits;
    for (const render::EyePolygon& polygon : sorted) {
      const auto t = hit(polygon, p, d);
      if (!t) continue;
      CHECK(*t <= before + 1e-9);
      before = *t;
      CHECK(++hits[polygon.source] == 1);  // pieces of one polygon do not overlap
      ++rays;
    }
  }
  CHECK(rays > 100);
  // The pieces of a polygon have its area.
  std::map<std::uint32_t, Vector3d> area;
  for (const render::EyePolygon& polygon : sorted) {
    for (std::size_t j = 1; j + 1 < polygon.x.size(); ++j) {
      area.try_emplace(polygon.source, Vector3d::Zero()).first->second +=
          (polygon.x[j] - polygon.x[0]).cross(polygon.x[j + 1] - polygon.x[0]);
    }
  }
  for (const render::EyePolygon& polygon : input)
    CHECK((area[polygon.source] - polygon.normal).norm() < 1e-6);
}

}  // namespace

TEST_CASE("random intersecting triangles are painted back to front") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-3, 3);
  for (const std::uint32_t count : {2U, 10U, 80U}) {
    for (const bool orthographic : {false, true}) {
      std::vector<render::EyePolygon> polygons;
      const auto corner = [&] { return Vector3d(u(random), u(random), 8 + u(random)); };
      for (std::uint32_t i = 0; i < count; ++i) polygons.push_back(triangle(corner(), corner(), corner(), i));
      check_order(polygons, orthographic, random);
    }
  }
}

TEST_CASE("polygons in one plane keep their order, degenerate ones are left out") {
  std::vector<render::EyePolygon> polygons;
  for (std::uint32_t i = 0; i < 5; ++i) polygons.push_back(triangle({-1, -1, 5}, {1, -1, 5}, {0, 1, 5}, i));
  auto sorted = render::back_to_front(polygons, false);
  REQUIRE(sorted.size() == 5);
  for (std::uint32_t i = 0; i < 5; ++i) CHECK(sorted[i].source == i);
  polygons.assign(30, triangle({1, 1, 4}, {1, 1, 4}, {2, 2, 4}, 9));
  CHECK(render::back_to_front(polygons, true).empty());
  // Many in one place, which no plane of the axes parts.
  polygons.assign(60, triangle({-1, -1, 4}, {1, -1, 5}, {0, 1, 6}, 9));
  CHECK(render::back_to_front(polygons, true).size() == 60);
  CHECK(render::back_to_front({}, true).empty());
}
