#include <array>
#include <cstdlib>
#include <string>
#include <thread>

#include <doctest/doctest.h>

#include "render/gl.hpp"
#include "tests/render/triangles.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/rasterize.hpp>

using namespace lrb;
using Eigen::Vector3d;

namespace {

render::Rasterizer& rasterizer() {
  static render::Rasterizer r;
  return r;
}

/// One pixel per unit, origin in the lower left corner, seen from above.
render::Camera pixel_camera(int width, int height) {
  render::Camera c;
  c.eye = {0.5 * width, 0.5 * height, 100};
  c.target = {0.5 * width, 0.5 * height, 0};
  c.up = {0, 1, 0};
  c.orthographic = true;
  c.half_height = 0.5 * height;
  return c;
}

render::DrawTriangle flat(render::Rgba colour, render::Layer layer = render::Layer::opaque) {
  render::DrawTriangle t;
  t.colour = colour;
  t.layer = layer;
  t.lit = false;
  return t;
}

/// A square in the plane z, as two triangles.
void square(render::DrawList& list, double x0, double y0, double x1, double y1, double z,
            render::DrawTriangle like) {
  list.add_polygon({{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, like);
}

render::RasterOptions size(int width, int height, int supersample = 2) {
  render::RasterOptions o;
  o.width = width;
  o.height = height;
  o.supersample = supersample;
  return o;
}

constexpr render::Rgba kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255};

bool near(render::Rgba a, render::Rgba b, int by = 2) {
  return std::abs(a.r - b.r) <= by && std::abs(a.g - b.g) <= by && std::abs(a.b - b.b) <= by &&
         std::abs(a.a - b.a) <= by;
}

}  // namespace

TEST_CASE("faces are at their positions, closer ones in front, rows from the top") {
  render::DrawList list;
  square(list, 10, 10, 50, 40, 0, flat(kRed));
  square(list, 30, 20, 60, 60, 1, flat(kGreen));
  const render::Image image = rasterizer().draw(list, pixel_camera(80, 64), size(80, 64));
  CHECK(image.at(5, 5) == render::kWhite);
  CHECK(image.at(10, 64 - 1 - 10) == kRed);
  CHECK(image.at(9, 64 - 1 - 10) == render::kWhite);
  CHECK(image.at(29, 64 - 1 - 39) == kRed);
  CHECK(image.at(30, 64 - 1 - 20) == kGreen);
  CHECK(image.at(49, 64 - 1 - 30) == kGreen);
  CHECK(image.at(59, 64 - 1 - 59) == kGreen);
  CHECK(image.at(60, 64 - 1 - 59) == render::kWhite);
}

TEST_CASE("supersampling averages in integers; the background may be transparent") {
  render::DrawList list;
  square(list, 10, 10, 20.5, 20, 0, flat(kRed));
  render::RasterOptions o = size(32, 32);
  render::Image image = rasterizer().draw(list, pixel_camera(32, 32), o);
  CHECK(image.at(20, 31 - 15) == render::Rgba{255, 128, 128});
  o.background.reset();
  image = rasterizer().draw(list, pixel_camera(32, 32), o);
  CHECK(image.at(15, 31 - 15) == kRed);
  CHECK(image.at(0, 0) == render::kTransparent);
  CHECK(near(image.at(20, 31 - 15), {255, 0, 0, 128}));
  o.background = render::Rgba{7, 8, 9};
  CHECK(rasterizer().draw({}, pixel_camera(32, 32), o).at(3, 3) == render::Rgba{7, 8, 9});
}

TEST_CASE("in a close-up among large bodies, lines on top are hidden correctly") {
  // A slope across the view, a line on it and one as far behind it as it is wide, and then some.
  render::DrawList list;
  render::DrawTriangle t = flat(kGreen);
  list.add_polygon({{-1, -1, -0.7}, {1, -1, -0.7}, {1, 1, 0.7}, {-1, 1, 0.7}}, t);
  list.add_polygon({{-90, -90, -200}, {90, -90, -200}, {0, 90, -200}}, t);
  list.add_polygon({{-90, -90, 50}, {90, -90, 50}, {0, 90, 50}}, t);  // behind the eye
  render::DrawLine line;
  line.colour = kRed;
  line.width = 6;
  line.layer = render::Layer::on_top;
  line.points = {{-0.6, 0, 0}, {0.6, 0, 0}};
  list.lines.push_back(line);
  line.points = {{-0.6, 0.4, 0.16}, {0.6, 0.4, 0.16}};  // the slope is at 0.28 there
  list.lines.push_back(line);
  render::Camera camera;
  camera.eye = {0, 0, 4};
  camera.target = Vector3d::Zero();
  camera.fov_y = 0.5;
  const render::Image image = rasterizer().draw(list, camera, size(300, 300));
  const auto red = [&](int x0, int y0, int x1, int y1) {
    int n = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) n += near(image.at(x, y), kRed) ? 1 : 0;
    }
    return n;
  };
  CHECK(red(100, 140, 200, 160) >= 590);  // its whole width, without a gap
  CHECK(red(100, 60, 200, 130) > 100);    // thinner, and dashed
  CHECK(red(100, 60, 200, 130) < 300);
}

TEST_CASE("translucent faces blend by depth in any order, also at intersections") {
  for (const bool swapped : {false, true}) {
    render::DrawList list;
    square(list, 0, 0, 40, 40, -5, flat(render::kWhite));
    render::DrawTriangle red = flat({255, 0, 0, 128}, render::Layer::translucent),
                         blue = flat({0, 0, 255, 128}, render::Layer::translucent);
    // Two planes that cross at x = 20: left of it red is nearer, right of it blue.
    const auto add_red = [&] { list.add_polygon({{5, 5, 2}, {35, 5, -2}, {35, 35, -2}, {5, 35, 2}}, red); };
    const auto add_blue = [&] { list.add_polygon({{5, 5, -2}, {35, 5, 2}, {35, 35, 2}, {5, 35, -2}}, blue); };
    if (swapped) {
      add_blue(), add_red();
    } else {
      add_red(), add_blue();
    }
    const render::Image image = rasterizer().draw(list, pixel_camera(40, 40), size(40, 40));
    CHECK(near(image.at(10, 20), {191, 64, 128}));
    CHECK(near(image.at(30, 20), {128, 64, 191}));
    CHECK(image.at(2, 2) == render::kWhite);
  }
}

TEST_CASE("a depth bias orders coplanar faces") {
  render::DrawList list;
  render::DrawTriangle lid = flat(kBlue);
  lid.nudge = 1;
  list.add_polygon({{0, 0, 0}, {40, 0, 13}, {40, 40, 13}, {0, 40, 0}}, flat(kRed));
  list.add_polygon({{0, 0, 0}, {20, 0, 6.5}, {40, 0, 13}, {40, 20, 13}, {40, 40, 13}, {0, 40, 0}}, lid);
  const render::Image image = rasterizer().draw(list, pixel_camera(40, 40), size(40, 40));
  for (int y = 1; y < 39; ++y) {
    for (int x = 1; x < 39; ++x) REQUIRE(image.at(x, y) == kBlue);
  }
}

TEST_CASE("fills follow the even-odd rule, with holes and in any order of segments") {
  render::DrawList list;
  render::DrawFill fill;
  fill.colour = kBlue;
  fill.id = 7;
  const auto loop = [&](std::vector<Vector3d> p) {
    for (std::size_t i = 0; i < p.size(); ++i) fill.segments.push_back({p[i], p[(i + 1) % p.size()]});
  };
  loop({{10, 10, 0}, {90, 10, 0}, {90, 90, 0}, {50, 55, 0}, {10, 90, 0}});  // not convex
  loop({{30, 20, 0}, {60, 20, 0}, {60, 40, 0}, {30, 40, 0}});               // a hole
  loop({{40, 25, 0}, {50, 25, 0}, {50, 35, 0}, {40, 35, 0}});               // an island in it
  std::swap(fill.segments[1], fill.segments[6]);
  std::swap(fill.segments[2][0], fill.segments[2][1]);
  list.fills.push_back(fill);
  const render::Image image = rasterizer().draw(list, pixel_camera(100, 100), size(100, 100));
  const auto at = [&](int x, int y) { return image.at(x, 99 - y); };
  CHECK(at(15, 50) == kBlue);
  CHECK(at(85, 80) == kBlue);
  CHECK(at(50, 70) == render::kWhite);
  CHECK(at(32, 30) == render::kWhite);
  CHECK(at(45, 30) == kBlue);
  CHECK(at(70, 30) == kBlue);
  CHECK(at(5, 5) == render::kWhite);
  const render::IdImage ids = rasterizer().ids(list, pixel_camera(100, 100), 100, 100);
  CHECK(ids.at(45, 99 - 30) == 7);
  CHECK(ids.at(32, 99 - 30) == render::kNoId);
}

TEST_CASE("ids name the visible face at each pixel") {
  render::DrawList list;
  render::DrawTriangle t;
  test::add(list, test::sphere_triangles(3), t, 1000);
  const auto points = render::extent_points(list);
  const render::Camera camera = render::fit_camera(points, 300, 200);
  const render::Projection projection(camera, 300, 200, render::bounds(list));
  const render::IdImage ids = rasterizer().ids(list, camera, 300, 200);
  int facing = 0, found = 0;
  for (const render::DrawTriangle& f : list.triangles) {
    const Vector3d centroid = (f.x[0] + f.x[1] + f.x[2]) / 3;
    const double cosine =
        (f.x[1] - f.x[0]).cross(f.x[2] - f.x[0]).normalized().dot(projection.towards_viewer(centroid));
    if (cosine < 0.5) continue;
    ++facing;
    const Eigen::Vector2d at = *projection.to_pixel(centroid);
    found += ids.at(static_cast<int>(at.x()), static_cast<int>(at.y())) == f.id;
  }
  CHECK(facing > 200);
  CHECK(found == facing);
  CHECK(ids.at(0, 0) == render::kNoId);
}

TEST_CASE("threads draw the same pictures, each with its rasterizer or one after another with a shared one") {
  render::DrawList list;
  render::DrawTriangle t;
  t.edges = 7;
  t.layer = render::Layer::translucent;
  t.colour = {0, 90, 200, 120};
  test::add(list, test::sphere_triangles(3), t);
  const render::Camera camera = render::fit_camera(render::extent_points(list), 160, 120);
  const render::Image expected = rasterizer().draw(list, camera, size(160, 120));
  const render::IdImage expected_ids = rasterizer().ids(list, camera, 160, 120, true);
  constexpr std::size_t kThreads = 4;
  constexpr int kRounds = 5;
  std::array<int, kThreads> wrong{};
  // At the same time.
  std::vector<std::thread> threads;
  for (int& count : wrong) {
    threads.emplace_back([&] {
      for (int i = 0; i < kRounds; ++i) {
        render::Rasterizer own;
        count += own.draw(list, camera, size(160, 120)) != expected;
        count += own.ids(list, camera, 160, 120, true).ids != expected_ids.ids;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  // Created by this thread, and used by others one after another.
  render::Rasterizer shared;
  for (int& count : wrong)
    std::thread([&] { count += shared.draw(list, camera, size(160, 120)) != expected; }).join();
  CHECK(shared.draw(list, camera, size(160, 120)) == expected);
  CHECK(wrong == std::array<int, kThreads>{});
}

TEST_CASE("impossible sizes are rejected") {
  CHECK_THROWS_AS(rasterizer().draw({}, pixel_camera(8, 8), size(0, 8)), InputError);
  CHECK_THROWS_AS(rasterizer().draw({}, pixel_camera(8, 8), size(20000, 8)), InputError);
  CHECK_THROWS_AS(rasterizer().draw({}, pixel_camera(8, 8), size(8, 8, 9)), InputError);
}

TEST_CASE("the environment is checked before Mesa starts") {
  using Level = render::Finding::Level;
  bool context = false;
  for (const render::Finding& f : render::check_rendering()) {
    if (f.what == "off-screen OpenGL")
      context = f.level == Level::ok && f.detail.find("llvmpipe") != std::string::npos;
  }
  CHECK(context);
  setenv("LP_NATIVE_VECTOR_WIDTH", "512", 1);
  CHECK_THROWS_AS(render::Rasterizer(), EnvironmentError);
  unsetenv("LP_NATIVE_VECTOR_WIDTH");
  setenv("GALLIUM_DRIVER", "nonsense", 1);
  REQUIRE(render::check_gl_environment().size() == 1);
  CHECK(render::check_gl_environment()[0].level == Level::error);
  CHECK_THROWS_AS(render::Rasterizer(), EnvironmentError);
  unsetenv("GALLIUM_DRIVER");
}

TEST_CASE("a transparent picture composited on a colour equals the picture drawn on that colour") {
  render::DrawList list;
  square(list, 10, 10, 70, 50, 0, flat({240, 240, 240}));
  square(list, 30.4, 20.3, 90, 58.7, 1, flat({255, 60, 0, 120}, render::Layer::translucent));
  square(list, 5, 40, 60.5, 57, 2, flat({0, 80, 255, 20}, render::Layer::translucent));
  list.lines.push_back({{{3, 3, 3}, {95, 57, 3}, {95, 5, 3}}, true, {250, 250, 210, 200}, 2.3F});
  const render::Camera camera = pixel_camera(100, 60);
  for (const int supersample : {1, 2, 3}) {
    render::RasterOptions options = size(100, 60, supersample);
    options.background.reset();
    const render::Image transparent = rasterizer().draw(list, camera, options);
    for (const render::Rgba back : {render::kWhite, render::kBlack, render::Rgba{200, 40, 160}}) {
      options.background = back;
      const render::Image expected = rasterizer().draw(list, camera, options);
      int worst = 0;
      for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 100; ++x) {
          const render::Rgba got = render::over(transparent.at(x, y), back), want = expected.at(x, y);
          worst =
              std::max({worst, std::abs(got.r - want.r), std::abs(got.g - want.g), std::abs(got.b - want.b)});
        }
      CHECK(worst <= 2);
    }
    bool partly = false;
    for (const render::Rgba p : transparent.pixels()) partly |= p.a > 0 && p.a < 255;
    CHECK(partly);
    CHECK(transparent.at(99, 59) == render::kTransparent);
  }
}
