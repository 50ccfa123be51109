#include "render/image.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "engine/error.hpp"
#include "render/image_diff.hpp"
#include "render/palette.hpp"

using namespace lrb;

TEST_CASE("painting over is the compositing formula, rounded") {
  std::mt19937 random(7);
  const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
  for (int i = 0; i < 20000; ++i) {
    const Rgba top{byte(), byte(), byte(), byte()}, below{byte(), byte(), byte(), byte()};
    const int coverage = byte();
    const Rgba got = over(top, below, coverage);
    const double at = top.a / 255.0 * coverage / 255, ab = below.a / 255.0 * (1 - at), a = at + ab;
    CHECK(std::abs(got.a - 255 * a) <= 1.6);
    if (a < 0.2) continue;  // few levels are left: the colour is coarse
    CHECK(std::abs(got.r - (top.r * at + below.r * ab) / a) <= 3.5);
  }
  CHECK(over({1, 2, 3, 255}, {9, 9, 9, 9}) == Rgba{1, 2, 3, 255});
  CHECK(over({1, 2, 3, 0}, {9, 9, 9, 9}) == Rgba{9, 9, 9, 9});
}

TEST_CASE("rectangles are clipped to the image") {
  Image image(10, 6);
  image.fill({-5, -5, 8, 7}, kBlack);
  CHECK(image.at(2, 1) == kBlack);
  CHECK(image.at(3, 1) == kWhite);
  CHECK(image.at(2, 2) == kWhite);
  image.stroke({4, 1, 4, 4}, {255, 0, 0});
  CHECK(image.at(4, 1) == Rgba{255, 0, 0});
  CHECK(image.at(7, 4) == Rgba{255, 0, 0});
  CHECK(image.at(5, 2) == kWhite);
  image.paste(Image(3, 3, {0, 0, 255}), 8, 4);
  CHECK(image.at(9, 5) == Rgba{0, 0, 255});
  CHECK_THROWS_AS(Image(0, 5), InputError);
  CHECK_THROWS_AS(Image(5, 40000), InputError);
}

TEST_CASE("hash follows every pixel and the shape") {
  const Image a(4, 6);
  Image b = a;
  CHECK(hash(a) == hash(b));
  b.at(3, 5).b = 254;
  CHECK(hash(a) != hash(b));
  CHECK(hash(Image(4, 6)) != hash(Image(6, 4)));
}

TEST_CASE("image difference counts in buckets") {
  const Image a(100, 100, {100, 100, 100});
  Image b = a;
  CHECK(compare(a, b).within());
  CHECK(compare(a, b).text() == "the images are equal");
  for (int x = 0; x < 100; ++x) b.at(x, 0).g = 102;  // 1 % by 2
  for (int x = 0; x < 50; ++x) b.at(x, 1).g = 106;   // 0.5 % by 6
  for (int x = 0; x < 5; ++x) b.at(x, 2).r = 150;    // 0.05 % by 50
  ImageDifference d = compare(a, b);
  CHECK(d.small == 100);
  CHECK(d.medium == 50);
  CHECK(d.large == 5);
  CHECK(d.largest == 50);
  CHECK(d.equal == 100 * 100 - 155);
  CHECK(d.within());
  b.at(5, 2).a = 200;
  d = compare(a, b);
  CHECK(!d.within());
  CHECK(d.text().find("strongly") != std::string::npos);
  Image noisy(100, 100, {101, 100, 100});
  d = compare(a, noisy);
  CHECK(!d.within());
  CHECK(d.text().find("slightly") != std::string::npos);
  CHECK(!compare(a, Image(100, 99)).within());

  const Image shown = difference_image(a, b);
  CHECK(shown.at(0, 0) == Rgba{0, 32, 0});
  CHECK(shown.at(0, 1) == Rgba{0, 96, 0});
  CHECK(shown.at(0, 2) == Rgba{255, 0, 0});
  CHECK(shown.at(5, 2) == Rgba{255, 255, 255});
  CHECK(shown.at(50, 50) == Rgba{0, 0, 0});
}

TEST_CASE("colours that must be told apart differ in grey") {
  CHECK(std::abs(luma(palette::body(Side::a)) - luma(palette::body(Side::b))) > 50);
  for (const Side side : {Side::a, Side::b}) {
    CHECK(std::abs(luma(palette::body(side)) - luma(palette::kContact)) > 30);
    CHECK(std::abs(luma(palette::body(side)) - luma(palette::edge_of(palette::body(side)))) > 50);
    CHECK(std::abs(luma(palette::solid_2d(palette::body(side))) -
                   luma(palette::region_2d(palette::body(side)))) > 60);
  }
}

TEST_CASE("viridis brightens from end to end and is clamped") {
  CHECK(palette::viridis(0) == Rgba{68, 1, 84});
  CHECK(palette::viridis(1) == Rgba{253, 231, 37});
  CHECK(palette::viridis(-1) == palette::viridis(0));
  CHECK(palette::viridis(7) == palette::viridis(1));
  CHECK(palette::viridis(std::nan("")) == palette::viridis(0));
  for (int i = 0; i < 100; ++i)
    CHECK(luma(palette::viridis(i / 100.0)) < luma(palette::viridis((i + 1) / 100.0)));
}

TEST_CASE("neighbouring categories look different") {
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Rgba a = palette::category(i), b = palette::category(i + 1);
    CHECK(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) > 60);
  }
}
