#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "render/face_look.hpp"
#include "tests/render/triangles.hpp"

using namespace lrb;
using Eigen::Vector3d;

namespace {

double altitude(const render::DrawTriangle& t, const render::Projection& projection) {
  double lowest = 1e9;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d a = *projection.to_pixel(t.x[i]), b = *projection.to_pixel(t.x[(i + 1) % 3]);
    const Eigen::Vector2d c = *projection.to_pixel(t.x[(i + 2) % 3]), u = (b - a).normalized();
    lowest = std::min(lowest, std::abs(u.x() * (c - a).y() - u.y() * (c - a).x()));
  }
  return lowest;
}

/// Every triangle with every other.
double brute_spacing(const render::DrawList& list, const render::DrawTriangle& t,
                     const render::Projection& projection) {
  double sum = 0;
  for (const Vector3d& x : t.x) {
    double here = 0;
    int count = 0;
    for (const render::DrawTriangle& o : list.triangles) {
      if (o.edges == 0 || o.edge_style != t.edge_style || std::count(o.x.begin(), o.x.end(), x) == 0)
        continue;
      here += altitude(o, projection);
      ++count;
    }
    sum += here / count;
  }
  return sum / 3;
}

}  // namespace

TEST_CASE("the spacing of edges is the local mean altitude of triangles of one style") {
  render::DrawList list;
  render::DrawTriangle t;
  t.edges = 7;
  test::add(list, test::sphere_triangles(2), t);
  t.edge_style = list.edge_style({render::kBlack, 3});
  test::add(list, test::sphere_triangles(1), t);  // shares corners with the first, not the style
  t.edges = 0;
  test::add(list, test::sphere_triangles(1, 1.5), t);
  const auto points = render::extent_points(list);
  const render::Projection projection(render::fit_camera(points, 640, 480), 640, 480, render::bounds(list));
  const std::vector<double> spacing = render::edge_spacing(list, projection);
  REQUIRE(spacing.size() == list.triangles.size());
  for (std::size_t i = 0; i < spacing.size(); ++i) {
    const render::DrawTriangle& triangle = list.triangles[i];
    const double expected = triangle.edges == 0 ? 0 : brute_spacing(list, triangle, projection);
    CHECK(spacing[i] == doctest::Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("the spacing of borders depends on their length in the area of their style") {
  // A grid of 8 x 8 squares of two triangles each, in blocks of 4 x 4 squares with borders.
  render::DrawList list;
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y) {
      render::DrawTriangle t;
      t.edges = 7;
      const bool left = x % 4 == 0, right = x % 4 == 3, low = y % 4 == 0, high = y % 4 == 3;
      const auto corner = [&](int i, int j) { return Vector3d(x + i, y + j, 0); };
      list.add_polygon({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}, t, {low, right, high, left});
    }
  const auto points = render::extent_points(list);
  const render::Projection projection(render::fit_top(points, 640, 640), 640, 640, render::bounds(list));
  const std::vector<render::StyleSpacing> spacing = render::even_edge_spacing(list, projection);
  REQUIRE(spacing.size() == 1);
  const double unit = projection.focal();
  CHECK(spacing[0].all == doctest::Approx(unit / std::sqrt(2.0)));
  CHECK(spacing[0].borders == doctest::Approx(6 * 64 * unit / 64));  // four blocks of circumference 16
  // Only borders are left where faces are too small for the width of edges.
  for (const double width : {1.0, 40.0}) {
    CAPTURE(width);
    list.edge_styles[0].width = static_cast<float>(width);
    const render::FaceLooks looks(list, projection, 1, {}, true);
    const render::FaceLook inner = looks.of(list.triangles[2 * 9]), corner = looks.of(list.triangles[0]);
    CHECK(inner.edges == (width > 1 ? 0 : 3));
    CHECK(corner.edges == (width > 1 ? 1 : 3));
    CHECK(corner.edge_colour.a > 0);
  }
}
