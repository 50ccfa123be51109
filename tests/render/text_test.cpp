#include <cstdlib>

#include <doctest/doctest.h>

#include "render/canvas.hpp"
#include "tests/render/font_guard.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

using namespace lrb;

namespace {

/// The box of pixels that are not white.
render::PixelRect ink(const render::Image& image) {
  int x0 = image.width(), y0 = image.height(), x1 = -1, y1 = -1;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y) == render::kWhite) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  }
  return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

}  // namespace

TEST_CASE("UTF-8 is decoded, and invalid bytes become a replacement mark") {
  std::string_view text = "aé€\U0001F600\xff\xed\xa0\x80\xc3";
  std::vector<char32_t> got;
  while (!text.empty()) got.push_back(render::next_code_point(text));
  CHECK(got ==
        std::vector<char32_t>{U'a', U'é', U'€', U'\U0001F600', 0xFFFD, 0xFFFD, 0xFFFD, 0xFFFD, 0xFFFD});
  CHECK(render::escape_markup("\xe9<\xef\xbf\xbf\x1b") == "\ufffd&lt;\ufffd\\x1b");
}

TEST_CASE("a text stays within its measured box" * doctest::test_suite("font")) {
  test::need_font();
  const render::Font& font = render::default_font();
  for (const float height : {9.0F, 14.0F, 31.5F}) {
    for (const bool bold : {false, true}) {
      render::TextStyle style;
      style.height = height;
      style.bold = bold;
      const std::string text = "Wrapper (jAg) 1\u202f204 × 90°";
      const render::TextSize size = font.measure(text, style);
      render::Image image(size.width + 40, size.height + 40);
      font.draw(image, text, 20, 20, style);
      const render::PixelRect box = ink(image);
      CHECK(render::PixelRect{18, 19, size.width + 4, size.height + 2}.contains(box));
      CHECK(box.width > 0.9 * size.width);
      CHECK(box.height > 0.6 * size.height);
    }
  }
}

TEST_CASE("a missing font is reported with a remedy") {
  const char* const old = std::getenv("LRB_FONT");
  const std::string kept = old == nullptr ? "" : old;
  setenv("LRB_FONT", "/nowhere/font.ttf", 1);
  CHECK_THROWS_AS(render::find_font(), EnvironmentError);
  try {
    render::find_font();
  } catch (const EnvironmentError& e) {
    CHECK(std::string(e.what()).find("/nowhere/font.ttf") != std::string::npos);
  }
  if (old == nullptr) {
    unsetenv("LRB_FONT");
  } else {
    setenv("LRB_FONT", kept.c_str(), 1);
  }
}
