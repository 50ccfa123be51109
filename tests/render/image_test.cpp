#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

using namespace lrb;

TEST_CASE("painting over is the rounded compositing formula") {
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

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

std::array<double, 3> times(const Matrix& m, const std::array<double, 3>& v) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i] += m[i][j] * v[j];
  return out;
}

/// Lightness and the two hues of CIE 1976 of a colour of sRGB, as somebody sees it whose linear RGB is `seen`
/// times ours.
std::array<double, 3> lab(render::Rgba c, const Matrix& seen) {
  const auto linear = [](std::uint8_t byte) {
    const double x = byte / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  constexpr Matrix kToXyz = {{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
  const std::array<double, 3> xyz = times(kToXyz, times(seen, {linear(c.r), linear(c.g), linear(c.b)}));
  const std::array<double, 3> white = times(kToXyz, {1, 1, 1});
  const auto root = [&](std::size_t i) {
    const double t = std::max(xyz[i] / white[i], 0.0);
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  return {116 * root(1) - 16, 500 * (root(0) - root(1)), 200 * (root(1) - root(2))};
}

}  // namespace

TEST_CASE("kinds differ in lightness, and for all common kinds of colour vision") {
  // Severity 1 of G. Machado, M. Oliveira, L. Fernandes, "A physiologically-based model for simulation of
  // color vision deficiency", 2009: normal vision, protanopia, deuteranopia, tritanopia.
  const std::vector<Matrix> eyes = {
      {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
      {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
      {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}};
  struct Wanted {
    render::StyleName name;
    double lightness;  // between any two kinds
  };
  for (const Wanted& wanted : {Wanted{render::StyleName::screen, 6}, Wanted{render::StyleName::print, 11},
                               Wanted{render::StyleName::dark, 8}}) {
    const render::Style& style = render::style_of(wanted.name);
    CAPTURE(static_cast<int>(wanted.name));
    const std::vector<render::Rgba> kinds = {style.body(Side::a), style.body(Side::b), style.contact,
                                             style.refining, style.under_test};
    for (std::size_t eye = 0; eye < eyes.size(); ++eye)
      for (std::size_t i = 0; i < kinds.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          CAPTURE(eye);
          CAPTURE(i);
          CAPTURE(j);
          const auto x = lab(kinds[i], eyes[eye]), y = lab(kinds[j], eyes[eye]);
          CHECK(std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) > 10);  // 2.3 can just be noticed
          if (eye == 0) CHECK(std::abs(x[0] - y[0]) > wanted.lightness);
        }
  }
}

TEST_CASE("texts, lines and bodies stand out from the background of each style") {
  // WCAG 2: 4.5 for text, 3 for graphics; a thin frame may be fainter.
  const auto luminance = [](render::Rgba c) {
    const double lightness = lab(c, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}})[0];
    return std::pow((lightness + 16) / 116, 3);
  };
  for (const render::StyleName name :
       {render::StyleName::screen, render::StyleName::print, render::StyleName::dark}) {
    CAPTURE(static_cast<int>(name));
    const render::Style& style = render::style_of(name);
    const auto contrast = [&](render::Rgba c) {
      const double a = luminance(c) + 0.05, b = luminance(style.paper) + 0.05;
      return std::max(a, b) / std::min(a, b);
    };
    CHECK(contrast(style.ink) > 12);
    CHECK(contrast(style.faint) > 4.5);
    CHECK(contrast(style.contact) > 4.5);
    for (const Side side : {Side::a, Side::b}) {
      CHECK(contrast(style.edge_of(style.body(side))) > 7);
      CHECK(contrast(style.solid_2d(style.body(side), side)) > 3);
      // The solid stands out from the regions around it, whose fill lets the paper through, and contacts from
      // both.
      const render::Rgba region = render::over(render::with_alpha(style.body(side), 78), style.paper);
      CHECK(std::abs(luma(style.solid_2d(style.body(side), side)) - luma(region)) > 40);
      CHECK(std::abs(lab(style.contact, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}})[0] -
                     lab(style.body(side), {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}})[0]) > 8);
    }
  }
}
