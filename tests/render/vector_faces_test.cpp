#include "render/vector_faces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <doctest/doctest.h>

#include "tests/render/triangles.hpp"

using namespace lrb;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr int kSide = 240;

render::Projection projection_of(const render::Camera& camera, const render::DrawList& list) {
  return {camera, kSide, kSide, render::bounds(list)};
}

render::Camera camera_for(const render::DrawList& list, bool orthographic) {
  render::FitOptions options;
  options.orthographic = orthographic;
  return render::fit_camera(render::extent_points(list), kSide, kSide, options);
}

std::vector<std::uint32_t> all_of(const render::DrawList& list) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < list.triangles.size(); ++i) out.push_back(i);
  return out;
}

std::vector<render::ScreenFace> ordered(const render::DrawList& list, const render::Projection& projection) {
  const render::Lighting lighting;
  return render::painting_order(list, projection, {list, projection, 1, lighting, true}, all_of(list))
      .value();
}

bool well_inside(const render::ScreenFace& f, const Vector2d& x) {
  for (std::size_t i = 0; i < f.corners.size(); ++i) {
    const Vector2d a = f.corners[i], along = (f.corners[(i + 1) % f.corners.size()] - a).normalized();
    if (along.x() * (x.y() - a.y()) - along.y() * (x.x() - a.x()) < 0.02) return false;
  }
  return true;
}

double area_of(const render::ScreenFace& f) {
  double sum = 0;
  for (std::size_t i = 0; i < f.corners.size(); ++i) {
    const Vector2d &a = f.corners[i], &b = f.corners[(i + 1) % f.corners.size()];
    sum += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return sum;
}

/// Random triangles, many of which intersect or overlap cyclically.
render::DrawList tangle(std::uint32_t seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  render::DrawList list;
  for (int i = 0; i < count; ++i) {
    render::DrawTriangle t;
    const Vector3d centre(u(random), u(random), u(random));
    for (Vector3d& x : t.x) x = centre + 0.6 * Vector3d(u(random), u(random), u(random));
    t.colour = {static_cast<std::uint8_t>(40 + i % 5 * 40), static_cast<std::uint8_t>(i * 37 % 256), 120,
                255};
    t.layer = i % 3 == 0 ? render::Layer::translucent : render::Layer::opaque;
    if (t.layer == render::Layer::translucent) t.colour.a = 120;
    list.triangles.push_back(t);
  }
  return list;
}

}  // namespace

TEST_CASE("faces are painted from back to front at every point, and parts cover their triangle once") {
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U})
    for (const bool orthographic : {false, true}) {
      CAPTURE(seed);
      CAPTURE(orthographic);
      const render::DrawList list = tangle(seed, 60);
      const render::Projection projection = projection_of(camera_for(list, orthographic), list);
      const std::vector<render::ScreenFace> faces = ordered(list, projection);
      CHECK(faces.size() > list.triangles.size());  // some intersect
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> u(0, kSide);
      int hits = 0;
      for (int i = 0; i < 4000; ++i) {
        const Vector2d x(u(random), u(random));
        double before = 2;
        std::set<std::uint32_t> seen;
        for (const render::ScreenFace& f : faces) {
          if (!well_inside(f, x)) continue;
          // Each face is nearer than those painted before it, but for parts too narrow to be seen.
          CHECK(f.depth_at(x) <= before + 2e-3);
          before = f.depth_at(x);
          CHECK(seen.insert(f.triangle).second);
          ++hits;
        }
      }
      CHECK(hits > 1500);
      std::map<std::uint32_t, double> area;
      for (const render::ScreenFace& f : faces) area[f.triangle] += area_of(f);
      for (const auto& [i, sum] : area) {
        std::array<Vector2d, 3> x;
        for (std::size_t k = 0; k < 3; ++k) x[k] = *projection.to_pixel(list.triangles[i].x[k]);
        const Vector2d a = x[1] - x[0], b = x[2] - x[0];
        CHECK(sum == doctest::Approx(std::abs(a.x() * b.y() - a.y() * b.x()) / 2).epsilon(0.01));
      }
    }
}

TEST_CASE("faces are split only if they intersect or overlap cyclically") {
  render::DrawList list;
  render::DrawTriangle like;
  like.colour = {100, 150, 200, 255};
  test::add(list, test::sphere_triangles(2), like);
  test::add(list, test::box_triangles({1, -1, -1}, {2, 1, 1}), like);
  for (const bool orthographic : {false, true}) {
    std::set<std::uint32_t> sources;
    for (const render::ScreenFace& f : ordered(list, projection_of(camera_for(list, orthographic), list)))
      CHECK(sources.insert(f.triangle).second);
    CHECK(sources.size() + 4 > list.triangles.size());  // without those seen edge-on
  }
  // Three sticks in a cycle, seen from above: each is over the next one.
  render::DrawList sticks;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 3;
    const Eigen::AngleAxisd turned(angle, Vector3d::UnitZ());
    like.x = {turned * Vector3d(-1, -0.30, 0.3), turned * Vector3d(1, -0.35, -0.3),
              turned * Vector3d(1, -0.20, -0.3)};
    sticks.triangles.push_back(like);
  }
  render::Camera camera;
  camera.eye = {0, 0, 5};
  camera.orthographic = true;
  camera.half_height = 1.2;
  CHECK(ordered(sticks, projection_of(camera, sticks)).size() == 4);
  // Two triangles that intersect: one of them is split, the opaque one.
  render::DrawList crossing;
  like.x = {Vector3d(-1, -1, 0), {1, -1, 0}, {0, 1, 0}};
  like.layer = render::Layer::translucent;
  crossing.triangles.push_back(like);
  like.layer = render::Layer::opaque;
  like.x = {Vector3d(-1, 0, -1), {1, 0.1, 1}, {1, -0.1, 1}};
  crossing.triangles.push_back(like);
  const auto faces = ordered(crossing, projection_of(camera, crossing));
  REQUIRE(faces.size() == 3);
  CHECK(faces[0].triangle == 1);
  CHECK(faces[1].triangle == 0);
  CHECK(faces[2].triangle == 1);
  // The cut is not an edge of the triangle.
  CHECK(std::count(faces[0].edges.begin(), faces[0].edges.end(), -1) == 1);
}

TEST_CASE("faces that opaque faces hide entirely are removed") {
  render::DrawList list;
  render::DrawTriangle like;
  like.colour = {100, 150, 200, 255};
  test::add(list, test::sphere_triangles(3), like);
  const std::size_t ball = list.triangles.size();
  test::add(list, test::sphere_triangles(1, 0.5), like);  // inside
  like.layer = render::Layer::translucent;
  like.colour.a = 100;
  test::add(list, test::sphere_triangles(1, 0.6), like);
  const std::size_t hidden = list.triangles.size();
  test::add(list, test::sphere_triangles(1, 1.3), like);  // around
  const render::Camera camera = camera_for(list, false);
  render::Rasterizer rasterizer;
  constexpr int kFine = 3 * kSide;
  const auto visible =
      render::visible_faces(list, projection_of(camera, list), rasterizer.depths(list, camera, kFine, kFine));
  REQUIRE(visible);
  for (std::size_t i = ball; i < hidden; ++i) CHECK(std::count(visible->begin(), visible->end(), i) == 0);
  // At least all that have pixels, and no more than those on the near half and at the silhouette.
  for (render::DrawTriangle& t : list.triangles)
    t.id = static_cast<std::uint32_t>(&t - list.triangles.data());
  const render::IdImage ids = rasterizer.ids(list, camera, kFine, kFine);
  std::set<std::uint32_t> seen(ids.ids.begin(), ids.ids.end());
  seen.erase(render::kNoId);
  CHECK(std::includes(visible->begin(), visible->end(), seen.begin(), seen.end()));
  const auto opaque =
      std::count_if(visible->begin(), visible->end(), [&](std::uint32_t i) { return i < ball; });
  CHECK(opaque <= static_cast<std::ptrdiff_t>(seen.size() + seen.size() / 8));
  // The outer faces behind the ball are hidden, those beside it are not.
  CHECK(visible->size() - static_cast<std::size_t>(opaque) < list.triangles.size() - hidden);
  list.triangles[0].layer = render::Layer::on_top;
  CHECK_FALSE(render::visible_faces(list, projection_of(camera, list),
                                    rasterizer.depths(list, camera, kFine, kFine)));
}

TEST_CASE("faces with too many parts are not ordered, after a bounded time") {
  const render::DrawList list = tangle(7, 2000);
  const render::Camera camera = camera_for(list, true);
  const render::Projection projection = projection_of(camera, list);
  const render::Lighting lighting;
  CHECK_FALSE(render::painting_order(list, projection, {list, projection, 1, lighting, true}, all_of(list)));
}

TEST_CASE("each edge is painted once, with the last face that has it") {
  struct Lines : render::Canvas {
    std::vector<std::size_t> of_fill;  ///< lines after each fill
    void fill(const std::vector<Loop>& /*loops*/, render::Rgba /*colour*/, double /*spread*/) override {
      of_fill.push_back(0);
    }
    void stroke(const Loop& /*points*/, bool /*closed*/, const render::Pen& /*pen*/) override {}
    void strokes(const std::vector<Loop>& lines, const render::Pen& /*pen*/) override {
      of_fill.back() += lines.size();
    }
    void disc(const Vector2d& /*at*/, double /*radius*/, render::Rgba /*colour*/) override {}
    void text(const render::PaperText& /*text*/) override {}
    void picture(const render::Image& /*image*/, const Eigen::AlignedBox2d& /*place*/) override {}
    void begin_clip(const Eigen::AlignedBox2d& /*box*/) override {}
    void end_clip() override {}
  };
  render::DrawList list;
  render::DrawTriangle like;
  like.colour = {100, 150, 200, 255};
  like.edges = 7;
  test::add(list, test::box_triangles({0, 0, 0}, {1, 1, 1}), like);
  render::FitOptions from_corner;
  from_corner.view.from = {1, 0.8, 0.6};
  const render::Camera camera = render::fit_camera(render::extent_points(list), kSide, kSide, from_corner);
  const render::Projection projection = projection_of(camera, list);
  render::Rasterizer rasterizer;
  const render::IdImage ids = rasterizer.ids(list, camera, kSide, kSide);
  std::set<std::uint32_t> seen(ids.ids.begin(), ids.ids.end());
  seen.erase(render::kNoId);
  REQUIRE(seen.size() == 6);
  const std::vector<std::uint32_t> visible(seen.begin(), seen.end());
  const render::Lighting lighting;
  const render::FaceLooks looks(list, projection, 1, lighting, true);
  Lines lines;
  render::paint_faces(lines, list, render::painting_order(list, projection, looks, visible).value(), looks,
                      {0, 0});
  // Three sides, each in one colour and one path. Nine edges of the box and three diagonals are visible.
  CHECK(lines.of_fill.size() == 3);
  std::size_t sum = 0;
  for (const std::size_t n : lines.of_fill) sum += n;
  CHECK(sum == 12);
}
