#include "render/image.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "engine/core/error.hpp"
#include "render/image_diff.hpp"
#include "render/palette.hpp"

using namespace lrb;

TEST_CASE("painting over is the compositing formula, rounded") {
  std::mt19937 random(7);
  const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
  for (int i = 0; i < 20000; ++i) {
    const render::Rgba top{byte(), byte(), byte(), byte()}, below{byte(), byte(), byte(), byte()};
    const int coverage = byte();
    const render::Rgba got = render::over(top, below, coverage);
    const double at = top.a / 255.0 * coverage / 255, ab = below.a / 255.0 * (1 - at), a = at + ab;
    CHECK(std::abs(got.a - 255 * a) <= 1.6);
    if (a < 0.2) continue;  // few levels are left: the colour is coarse
    CHECK(std::abs(got.r - (top.r * at + below.r * ab) / a) <= 3.5);
  }
  CHECK(render::over({1, 2, 3, 255}, {9, 9, 9, 9}) == render::Rgba{1, 2, 3, 255});
  CHECK(render::over({1, 2, 3, 0}, {9, 9, 9, 9}) == render::Rgba{9, 9, 9, 9});
}

TEST_CASE("rectangles are clipped to the image") {
  render::Image image(10, 6);
  image.fill({-5, -5, 8, 7}, render::kBlack);
  CHECK(image.at(2, 1) == render::kBlack);
  CHECK(image.at(3, 1) == render::kWhite);
  CHECK(image.at(2, 2) == render::kWhite);
  image.stroke({4, 1, 4, 4}, {255, 0, 0});
  CHECK(image.at(4, 1) == render::Rgba{255, 0, 0});
  CHECK(image.at(7, 4) == render::Rgba{255, 0, 0});
  CHECK(image.at(5, 2) == render::kWhite);
  image.paste(render::Image(3, 3, {0, 0, 255}), 8, 4);
  CHECK(image.at(9, 5) == render::Rgba{0, 0, 255});
  CHECK_THROWS_AS(render::Image(0, 5), InputError);
  CHECK_THROWS_AS(render::Image(5, 40000), InputError);
}

TEST_CASE("hash follows every pixel and the shape") {
  const render::Image a(4, 6);
  render::Image b = a;
  CHECK(render::hash(a) == render::hash(b));
  b.at(3, 5).b = 254;
  CHECK(render::hash(a) != render::hash(b));
  CHECK(render::hash(render::Image(4, 6)) != render::hash(render::Image(6, 4)));
}

TEST_CASE("image difference counts in buckets") {
  const render::Image a(100, 100, {100, 100, 100});
  render::Image b = a;
  CHECK(render::compare(a, b).within());
  CHECK(render::compare(a, b).text() == "the images are equal");
  for (int x = 0; x < 100; ++x) b.at(x, 0).g = 102;  // 1 % by 2
  for (int x = 0; x < 50; ++x) b.at(x, 1).g = 106;   // 0.5 % by 6
  for (int x = 0; x < 5; ++x) b.at(x, 2).r = 150;    // 0.05 % by 50
  render::ImageDifference d = render::compare(a, b);
  CHECK(d.small == 100);
  CHECK(d.medium == 50);
  CHECK(d.large == 5);
  CHECK(d.largest == 50);
  CHECK(d.equal == 100 * 100 - 155);
  CHECK(d.within());
  b.at(5, 2).a = 200;
  d = render::compare(a, b);
  CHECK(!d.within());
  CHECK(d.text().find("strongly") != std::string::npos);
  render::Image noisy(100, 100, {101, 100, 100});
  d = render::compare(a, noisy);
  CHECK(!d.within());
  CHECK(d.text().find("slightly") != std::string::npos);
  CHECK(!render::compare(a, render::Image(100, 99)).within());

  const render::Image shown = render::difference_image(a, b);
  CHECK(shown.at(0, 0) == render::Rgba{0, 32, 0});
  CHECK(shown.at(0, 1) == render::Rgba{0, 96, 0});
  CHECK(shown.at(0, 2) == render::Rgba{255, 0, 0});
  CHECK(shown.at(5, 2) == render::Rgba{255, 255, 255});
  CHECK(shown.at(50, 50) == render::Rgba{0, 0, 0});
}

TEST_CASE("colours that must be told apart differ in grey") {
  CHECK(std::abs(render::luma(render::palette::body(Side::a)) -
                 render::luma(render::palette::body(Side::b))) > 50);
  for (const Side side : {Side::a, Side::b}) {
    CHECK(std::abs(render::luma(render::palette::body(side)) - render::luma(render::palette::kContact)) > 30);
    CHECK(std::abs(render::luma(render::palette::body(side)) -
                   render::luma(render::palette::edge_of(render::palette::body(side)))) > 50);
    CHECK(std::abs(render::luma(render::palette::solid_2d(render::palette::body(side))) -
                   render::luma(render::palette::region_2d(render::palette::body(side)))) > 60);
  }
}

TEST_CASE("viridis brightens from end to end and is clamped") {
  CHECK(render::palette::viridis(0) == render::Rgba{68, 1, 84});
  CHECK(render::palette::viridis(1) == render::Rgba{253, 231, 37});
  CHECK(render::palette::viridis(-1) == render::palette::viridis(0));
  CHECK(render::palette::viridis(7) == render::palette::viridis(1));
  CHECK(render::palette::viridis(std::nan("")) == render::palette::viridis(0));
  for (int i = 0; i < 100; ++i)
    CHECK(render::luma(render::palette::viridis(i / 100.0)) <
          render::luma(render::palette::viridis((i + 1) / 100.0)));
}

TEST_CASE("neighbouring categories look different") {
  for (std::uint32_t i = 0; i < 200; ++i) {
    const render::Rgba a = render::palette::category(i), b = render::palette::category(i + 1);
    CHECK(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) > 60);
  }
}
