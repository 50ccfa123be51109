#include "render/paint_list.hpp"

#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "render/canvas.hpp"
#include "tests/render/font_guard.hpp"
#include "tests/support/pdf_text.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;
using Eigen::Vector2d;
using Eigen::Vector3d;
using lrb::test::count;

namespace {

/// Notes down what is painted.
struct Notes : render::Canvas {
  struct Stroke {
    Loop points;
    bool closed = false;
    render::Pen pen;
  };
  std::vector<Stroke> drawn;
  std::vector<Vector2d> discs;

  void fill(const std::vector<Loop>& /*loops*/, render::Rgba /*colour*/, double /*spread*/) override {}
  void stroke(const Loop& points, bool closed, const render::Pen& pen) override {
    drawn.push_back({points, closed, pen});
  }
  void strokes(const std::vector<Loop>& lines, const render::Pen& pen) override {
    for (const Loop& line : lines) stroke(line, false, pen);
  }
  void disc(const Vector2d& at, double /*radius*/, render::Rgba /*colour*/) override { discs.push_back(at); }
  void text(const render::PaperText& /*text*/) override {}
  void picture(const render::Image& /*image*/, const Eigen::AlignedBox2d& /*place*/) override {}
  void begin_clip(const Eigen::AlignedBox2d& /*box*/) override {}
  void end_clip() override {}
};

/// A square from x = 0 to the right, seen from above, that hides what lies below it.
render::DrawList half_covered() {
  render::DrawList list;
  render::DrawTriangle like;
  like.colour = {200, 200, 200, 255};
  list.add_polygon({{0, -1, 1}, {1, -1, 1}, {1, 1, 1}, {0, 1, 1}}, like);
  return list;
}

render::Camera from_above() {
  render::Camera camera;
  camera.eye = {0, 0, 5};
  camera.orthographic = true;
  return camera;
}

constexpr int kSide = 200;

Notes painted(const render::DrawList& list) {
  const render::Camera camera = from_above();
  render::Rasterizer rasterizer;
  const render::DepthImage depths = rasterizer.depths(list, camera, 2 * kSide, 2 * kSide);
  Notes notes;
  render::paint_over(notes, list, render::Projection(camera, kSide, kSide, render::bounds(list)), depths,
                     {10, 20});
  return notes;
}

render::DrawLine line_on_top(double z) {
  render::DrawLine line;
  line.points = {{-0.8, 0, z}, {0.8, 0, z}};
  line.colour = render::kBlack;
  line.width = 2;
  line.layer = render::Layer::on_top;
  return line;
}

}  // namespace

TEST_CASE("a line on top is split where a face begins to hide it, and dashed from there") {
  render::DrawList list = half_covered();
  list.lines.push_back(line_on_top(0));
  const Notes notes = painted(list);
  REQUIRE(notes.drawn.size() == 2);
  const Notes::Stroke &hidden = notes.drawn[0], &seen = notes.drawn[1];
  // From -0.8 to 0.8 of [-1, 1] on 200, moved by (10, 20).
  CHECK((seen.points.front() - Vector2d(30, 120)).norm() < 1e-9);
  CHECK((seen.points.back() - Vector2d(110, 120)).norm() < 1);
  CHECK(seen.pen.dash == 0);
  CHECK(seen.pen.width == 2);
  CHECK((hidden.points.front() - seen.points.back()).norm() < 1e-9);
  CHECK((hidden.points.back() - Vector2d(190, 120)).norm() < 1e-9);
  CHECK(hidden.pen.dash > 0);
  CHECK(hidden.pen.width < 2);
}

TEST_CASE("a hidden point on top is drawn as a ring") {
  render::DrawList list = half_covered();
  render::DrawPoint point;
  point.layer = render::Layer::on_top;
  for (const double x : {-0.5, 0.5}) {
    point.x = Vector3d(x, 0, 0);
    list.points.push_back(point);
  }
  const Notes notes = painted(list);
  REQUIRE(notes.discs.size() == 1);
  CHECK((notes.discs[0] - Vector2d(60, 120)).norm() < 1e-9);
  REQUIRE(notes.drawn.size() == 1);
  CHECK(notes.drawn[0].closed);
}

TEST_CASE("a scene with depth is not painted as if it were flat") {
  const render::DrawList list = half_covered();
  Notes notes;
  CHECK_THROWS_AS(
      render::paint_flat(notes, list, render::Projection(from_above(), 10, 10, render::bounds(list))),
      InputError);
}

TEST_CASE("a PDF has its size, its fonts, no date, and the same bytes each time" *
          doctest::test_suite("font")) {
  test::need_font();
  const auto paint = [](render::Canvas& canvas) {
    canvas.fill({{{10, 10}, {90, 10}, {90, 40}}}, {200, 0, 0, 128});
    canvas.text({{50, 30}, "text", 10});
    canvas.picture(render::Image(4, 4, render::kBlack), {Vector2d(0, 0), Vector2d(8, 8)});
  };
  const render::PaperPage page{100, 50, render::kWhite, "a title", "a program"};
  const std::string pdf = render::paint_pdf(page, paint);
  CHECK(pdf.starts_with("%PDF-1.5"));
  const std::string text = test::pdf_text(pdf);
  CHECK(count(text, "/MediaBox [ 0 0 100 50 ]") == 1);
  CHECK(count(text, "/FontFile") == 1);
  CHECK(count(text, "CreationDate") == 0);
  CHECK(count(text, "ModDate") == 0);
  CHECK(count(text, "a title") == 1);
  CHECK(pdf == render::paint_pdf(page, paint));
}

TEST_CASE("pixels of a canvas: sizes, colours, transparency") {
  const auto paint = [](render::Canvas& canvas) {
    canvas.fill({{{0, 0}, {36, 0}, {36, 72}, {0, 72}}}, {10, 20, 30, 255});
    canvas.begin_clip({Vector2d(36, 0), Vector2d(72, 36)});
    canvas.fill({{{0, 0}, {72, 0}, {72, 72}, {0, 72}}}, {0, 0, 255, 255});
    canvas.end_clip();
  };
  const render::Image image = render::paint_pixels({72, 72, {}, {}, {}}, 100, paint);
  REQUIRE(image.width() == 100);
  REQUIRE(image.height() == 100);
  CHECK(image.at(20, 80) == render::Rgba{10, 20, 30, 255});
  CHECK(image.at(80, 20) == render::Rgba{0, 0, 255, 255});
  CHECK(image.at(80, 80).a == 0);
}
