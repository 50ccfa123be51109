
#include <doctest/doctest.h>

#include "tests/render/font_guard.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>

using namespace lrb;

namespace {

render::Overlay full_overlay() {
  render::Overlay o;
  o.title = "Ball against ball, step 12 of 60, recursion complete, regularised wrappers";
  o.event = "Event 123 456: face test, pseudo face 1 234 of A against real face 99 938 of B: they cross";
  o.event_colour = render::palette::kYellow;
  o.counters = {{"face tests", "12 345 678"}, {"refinements", "87"}, {"wrapper A", "112"},
                {"wrapper B", "98"},          {"contacts", "23"},    {"regions refined", "1 234"}};
  using Mark = render::LegendItem::Mark;
  for (const char* text : {"A, real faces", "A, pseudo faces", "B, real faces", "B, pseudo faces",
                           "region being refined", "pair under test", "contact", "contact, hidden"}) {
    o.key.push_back({static_cast<Mark>(o.key.size() % 5), render::palette::kBlue, text});
  }
  o.scale = render::ScaleBar{"face tests per face", 0, 12345};
  return o;
}

std::vector<render::PixelRect> boxes(const render::OverlayLayout& layout) {
  std::vector<render::PixelRect> out{layout.picture};
  for (const auto& t : layout.texts) out.push_back(t.box);
  out.insert(out.end(), layout.key_marks.begin(), layout.key_marks.end());
  if (layout.event_mark.width > 0) out.push_back(layout.event_mark);
  if (layout.bar.width > 0) out.push_back(layout.bar);
  return out;
}

}  // namespace

TEST_CASE("in frames of the usual sizes nothing overlaps or is cut off" * doctest::test_suite("font")) {
  test::need_font();
  render::Overlay overlay = full_overlay();
  for (const bool scale : {true, false}) {
    if (!scale) overlay.scale.reset();
    for (const std::pair<int, int>& size :
         {std::pair{640, 360}, {1280, 720}, {1920, 1080}, {3840, 2160}, {600, 800}, {500, 500}}) {
      const int w = size.first, h = size.second;
      CAPTURE(w);
      const render::OverlayLayout layout = render::lay_out(overlay, w, h);
      const auto all = boxes(layout);
      for (std::size_t i = 0; i < all.size(); ++i) {
        CHECK(render::PixelRect{0, 0, w, h}.contains(all[i]));
        for (std::size_t j = 0; j < i; ++j) CHECK(!all[i].overlaps(all[j]));
      }
      CHECK(layout.picture.width == w);
      CHECK(layout.picture.height >= h / 2);
      CHECK(layout.text_height >= 10);
    }
  }
  CHECK_THROWS_AS(render::lay_out(overlay, 100, 60), InputError);
}

TEST_CASE("the overlay draws only within its layout" * doctest::test_suite("font")) {
  test::need_font();
  const render::Overlay overlay = full_overlay();
  const render::OverlayLayout layout = render::lay_out(overlay, 1280, 720);
  const render::Image picture(layout.picture.width, layout.picture.height, {1, 2, 3});
  const render::Image frame = render::compose_frame(picture, layout.picture, overlay, 1280, 720);
  for (int y = layout.picture.y; y < layout.picture.bottom(); ++y) {
    for (int x = 0; x < 1280; x += 5) REQUIRE(frame.at(x, y) == render::Rgba{1, 2, 3});
  }
  const render::PixelRect& m = layout.event_mark;
  CHECK(frame.at(m.x + m.width / 2, m.y + m.height / 2) == render::palette::kYellow);
  const render::PixelRect& s = layout.bar;
  CHECK(frame.at(s.x, s.y + 2) == render::palette::heat(0));
  CHECK(frame.at(s.right() - 1, s.y + 2) == render::palette::heat(1));
  for (const auto& t : layout.texts) {
    int ink = 0;
    for (int y = t.box.y; y < t.box.bottom(); ++y) {
      for (int x = t.box.x; x < t.box.right(); ++x) ink += frame.at(x, y) != render::kWhite;
    }
    CHECK(ink > 10);
  }
}

TEST_CASE("numbers are short and grouped") {
  CHECK(render::group_digits(0) == "0");
  CHECK(render::group_digits(999) == "999");
  CHECK(render::group_digits(1234567) == "1\u202f234\u202f567");
  CHECK(render::short_number(-1200) == "-1\u202f200");
  CHECK(render::short_number(1653.4) == "1\u202f653");
  CHECK(render::short_number(0.12345) == "0.123");
  CHECK(render::short_number(3e9) == "3e+09");
}
