#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/render/font_guard.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/svg.hpp>

using namespace lrb;
using Eigen::Vector2d;
using Eigen::Vector3d;
using lrb::test::count;

namespace {

struct PathFill {
  std::vector<std::vector<Vector2d>> loops;
  render::Rgba colour;

  /// By the even-odd rule: how many edges does a ray to the right cross?
  bool inside(const Vector2d& p) const {
    bool in = false;
    for (const auto& loop : loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
        if ((a.y() > p.y()) == (b.y() > p.y())) continue;
        if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x()) in = !in;
      }
    }
    return in;
  }
  /// Distance to the nearest edge.
  double distance(const Vector2d& p) const {
    double least = 1e9;
    for (const auto& loop : loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vector2d a = loop[i], u = loop[(i + 1) % loop.size()] - a;
        const double t = u.squaredNorm() > 0 ? std::clamp((p - a).dot(u) / u.squaredNorm(), 0.0, 1.0) : 0;
        least = std::min(least, (p - a - t * u).norm());
      }
    }
    return least;
  }
};

/// The value of an attribute of an element; empty if it has none.
std::string attribute(const std::string& element, const std::string& name) {
  const std::size_t at = element.find(" " + name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t first = at + name.size() + 3;
  return element.substr(first, element.find('"', first) - first);
}

std::vector<PathFill> fills_in(const std::string& text) {
  std::vector<PathFill> out;
  std::istringstream lines(text);
  for (std::string element; std::getline(lines, element);) {
    if (attribute(element, "fill-rule") != "evenodd") continue;
    PathFill f;
    const unsigned long rgb = std::stoul(attribute(element, "fill").substr(1), nullptr, 16);
    const std::string opacity = attribute(element, "fill-opacity");
    const double alpha = opacity.empty() ? 1 : std::stod(opacity);
    f.colour = {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8 & 255),
                static_cast<std::uint8_t>(rgb & 255), static_cast<std::uint8_t>(std::lround(255 * alpha))};
    std::istringstream d(attribute(element, "d"));
    for (char command = 0; d >> command;) {
      if (command == 'Z') continue;
      REQUIRE((command == 'M' || command == 'L'));
      if (command == 'M') f.loops.emplace_back();
      double x = 0, y = 0;
      d >> x >> y;
      f.loops.back().emplace_back(x, y);
    }
    out.push_back(f);
  }
  return out;
}

}  // namespace

TEST_CASE("fills of an SVG cover the rasterizer's pixels") {
  const LrbRep rep = build_lrb(shapes::star(9));
  const Wrapper wrapper(rep);
  render::DrawList list =
      render::build_scene(std::vector<render::SceneBody>{{&rep, &wrapper, {}, {}, ""}}).list;
  list.lines.clear();
  constexpr int kWidth = 200, kHeight = 150;
  const auto points = render::extent_points(list);
  const render::Camera camera = render::fit_top(points, kWidth, kHeight);
  render::SvgOptions options;
  options.width = kWidth, options.height = kHeight;
  const std::vector<PathFill> fills = fills_in(render::svg(list, camera, options));
  REQUIRE(fills.size() == list.fills.size());
  render::RasterOptions raster;
  raster.width = kWidth, raster.height = kHeight;
  render::Rasterizer rasterizer;
  const render::Image image = rasterizer.draw(list, camera, raster);
  int compared = 0, painted = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Vector2d p(x + 0.5, y + 0.5);
      render::Rgba expected = render::kWhite;
      bool near_edge = false;
      for (const PathFill& f : fills) {
        near_edge = near_edge || f.distance(p) < 1;
        if (f.inside(p)) expected = render::over(f.colour, expected);
      }
      if (near_edge) continue;
      const render::Rgba got = image.at(x, y);
      const int off = std::max(
          {std::abs(got.r - expected.r), std::abs(got.g - expected.g), std::abs(got.b - expected.b)});
      if (off > 2) FAIL("pixel ", x, " ", y, " is off by ", off);
      ++compared;
      painted += got == render::kWhite ? 0 : 1;
    }
  }
  CHECK(compared > kWidth * kHeight / 2);
  CHECK(painted > 2000);
}
