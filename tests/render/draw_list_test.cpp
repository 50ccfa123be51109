#include <algorithm>
#include <cmath>
#include <set>

#include <doctest/doctest.h>

#include "tests/render/triangles.hpp"
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/rasterize.hpp>

using namespace lrb;
using Eigen::Vector3d;

TEST_CASE("a polygon becomes a fan whose edges are its outline") {
  for (std::size_t n = 3; n <= 7; ++n) {
    std::vector<Vector3d> corners;
    for (std::size_t i = 0; i < n; ++i)
      corners.emplace_back(std::cos(0.8 * double(i)), std::sin(0.8 * double(i)), 0);
    render::DrawList list;
    render::DrawTriangle like;
    like.edges = 7;
    list.add_polygon(corners, like);
    REQUIRE(list.triangles.size() == n - 2);
    std::set<std::pair<std::size_t, std::size_t>> drawn;
    const auto index = [&](const Vector3d& x) {
      return static_cast<std::size_t>(std::find(corners.begin(), corners.end(), x) - corners.begin());
    };
    for (const render::DrawTriangle& t : list.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (t.edges >> i & 1) CHECK(drawn.emplace(index(t.x[i]), index(t.x[(i + 1) % 3])).second);
      }
    }
    REQUIRE(drawn.size() == n);
    for (std::size_t i = 0; i < n; ++i) CHECK(drawn.count({i, (i + 1) % n}) == 1);
  }
}

TEST_CASE("corners lie on the grid of 1/256 pixel") {
  render::DrawList list;
  test::add(list, test::sphere_triangles(2), {});
  const auto points = render::extent_points(list);
  const render::Camera camera = render::fit_camera(points, 641, 359);
  const render::Projection projection(camera, 641, 359, render::bounds(list));
  const render::ScreenMesh mesh = render::make_screen_mesh(list, projection, 1);
  REQUIRE(mesh.faces.size() == 320 * 3);
  for (const render::FaceVertex& v : mesh.faces) {
    const double x = (static_cast<double>(v.x[0]) + 1) / 2 * 641 * 256;
    const double y = (static_cast<double>(v.x[1]) + 1) / 2 * 359 * 256;
    CHECK(std::abs(x - std::round(x)) < 0.02);
    CHECK(std::abs(y - std::round(y)) < 0.02);
  }
}

TEST_CASE("geometry behind a camera within the scene is clipped") {
  render::DrawList list;
  test::add(list, test::sphere_triangles(2, 1), {});
  render::Camera camera;
  camera.eye = {0, 0, 0.2};
  camera.target = {0, 0, 0.9};
  camera.up = {0, 1, 0};
  const render::Projection projection(camera, 400, 400, render::bounds(list));
  const render::ScreenMesh mesh = render::make_screen_mesh(list, projection, 1);
  CHECK(mesh.faces.size() > 30);
  CHECK(mesh.faces.size() % 3 == 0);
  for (const render::FaceVertex& v : mesh.faces) {
    for (int i = 0; i < 3; ++i) CHECK(std::abs(v.x[i]) <= 18);
    CHECK(std::isfinite(v.edge[0]));
  }
}
