#include "render/pictures/panel.hpp"

#include <doctest/doctest.h>

#include "tests/render/font_guard.hpp"
#include "tests/render/triangles.hpp"

using namespace lrb;

namespace {

constexpr render::Rgba kPanelRed{200, 0, 0};

/// A panel that a red square fills, but for the margin.
run::Panel red(const std::string& title) {
  run::Panel panel;
  render::DrawTriangle flat;
  flat.colour = kPanelRed;
  flat.lit = false;
  test::add(panel.list, test::box_triangles({0, 0, 0}, {1, 1, 0.1}), flat);
  panel.camera = run::fit_points(render::extent_points(panel.list), 2);
  panel.title = title;
  return panel;
}

/// Returns the number of pixels of a rectangle that are not of a colour.
int others(const render::Image& image, const render::PixelRect& r, render::Rgba colour) {
  int n = 0;
  for (int y = r.y; y < r.bottom(); ++y)
    for (int x = r.x; x < r.right(); ++x) n += image.at(x, y) != colour;
  return n;
}

}  // namespace

TEST_CASE("titles are in their panels, and a look can omit them; transparent panels keep their alpha" *
          doctest::test_suite("font")) {
  test::need_font();
  render::Look look;
  render::Rasterizer rasterizer;
  const render::PixelRect picture{0, 0, 300, 200}, strip{0, 0, 300, 12};
  const std::vector<run::Panel> panels = {red("a title")};
  CHECK(others(run::draw_row(rasterizer, panels, look, picture), strip, render::kWhite) > 50);
  look.titles = false;
  CHECK(others(run::draw_row(rasterizer, panels, look, picture), strip, render::kWhite) == 0);
  look.transparent = true;
  const render::Image clear = run::draw_row(rasterizer, panels, look, picture);
  CHECK(clear.at(0, 0) == render::kTransparent);
  CHECK(clear.at(150, 100) == kPanelRed);
}
