#include <regex>
#include <string>

#include <doctest/doctest.h>

#include "scenarios/io/files.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/report/document.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/render/image.hpp>

using namespace lrb;
using lrb::test::count;

namespace {

report::Page full_page() {
  report::Page page;
  page.title = "A < B & \"C\" {{data}}";
  page.purpose = "</script><script>alert(1)</script>";
  page.verdict = "crossing";
  page.numbers = {{"pairs", "12", "at step 3"}};
  page.frames = {{"data:image/png;base64,AAAA", "</script>first", "frames/a.png", 0, 0},
                 {"data:image/png;base64,BBBB", "second", "frames/b.png", 7, 1}};
  report::PageChart chart;
  chart.title = "chart";
  chart.series = {{"s", {0, 1, 2}, {3, 4, 5}}};
  chart.cursor = report::PageCursor::event;
  page.charts = {chart};
  page.tables = {{"table", {"a", "b"}, {{"1", "x"}}, "note"}};
  page.command = "lrbscope run x";
  page.links = {{"trace.json", "trace.json", "opens in Perfetto"}};
  return page;
}

}  // namespace

TEST_CASE("numbers in tables are aligned right, with their digits in groups, too") {
  report::Page page = full_page();
  page.tables = {{"table", {"a", "b", "c"}, {{"1\u202f234", "0.5", "gear 3"}}, ""}};
  const std::string html = report::page_html(page);
  CHECK(html.find("<td class=\"n\">1\u202f234</td><td class=\"n\">0.5</td><td>gear 3</td>") !=
        std::string::npos);
}

TEST_CASE("a page fetches nothing: no address outside, all scripts and pictures inside") {
  std::string html = report::page_html(full_page());
  // The charting library's own banner names its home page; nothing is loaded from there.
  const std::string library(io::embedded_file("chart.min.js"));
  const std::size_t at = html.find(library);
  REQUIRE(at != std::string::npos);
  html.erase(at, library.size());
  CHECK(html.find("http:") == std::string::npos);
  CHECK(html.find("https:") == std::string::npos);
  CHECK(html.find("@import") == std::string::npos);
  CHECK_FALSE(std::regex_search(html, std::regex("\\ssrc=\"")));
  CHECK_FALSE(std::regex_search(html, std::regex("url\\(")));
  CHECK(html.find("default-src 'none'") != std::string::npos);  // and the browser is told so
}

TEST_CASE("text cannot become markup or end the data") {
  const std::string html = report::page_html(full_page());
  CHECK(html.find("<script>alert") == std::string::npos);
  CHECK(html.find("</script>first") == std::string::npos);
  CHECK(html.find("A &lt; B &amp; &quot;C&quot; {{data}}") != std::string::npos);  // marks in texts are texts
  CHECK(count(html, "<script") == count(html, "</script>"));
}

TEST_CASE("a page with a run's data has the view in three dimensions, and nothing of it comes from outside") {
  report::Page page = full_page();
  page.scene = R"({"name":"</script><b>"})";
  std::string html = report::page_html(page);
  for (const char* name : {"three.min.js", "OrbitControls.js", "chart.min.js"}) {
    const std::string library(io::embedded_file(name));
    const std::size_t at = html.find(library);
    REQUIRE(at != std::string::npos);
    html.erase(at, library.size());
  }
  CHECK(html.find("http:") == std::string::npos);
  CHECK(html.find("https:") == std::string::npos);
  CHECK(html.find("id=\"view-canvas\"") != std::string::npos);
  CHECK(html.find("function startScene()") != std::string::npos);
  CHECK(html.find("{\"name\":\"\\u003c/script>\\u003cb>\"}") != std::string::npos);
  CHECK(html.find("<details class=\"frames\"") != std::string::npos);
  CHECK(count(html, "<script") == count(html, "</script>"));
}

TEST_CASE("every script of the view is in the page, none twice") {
  report::Page page;
  page.scene = "{}";
  const std::string html = report::page_html(page);
  for (const io::EmbeddedFile& file : io::embedded_files())
    if (file.name.starts_with("scene") && file.name.ends_with(".js"))
      CHECK_MESSAGE(count(html, std::string(file.text)) == 1, file.name);
}

TEST_CASE("parts that a page does not have leave nothing behind") {
  report::Page page;
  page.title = "t";
  const std::string html = report::page_html(page);
  CHECK(html.find("<canvas") == std::string::npos);
  CHECK(html.find("id=\"player\"") == std::string::npos);
  CHECK(html.find("<table") == std::string::npos);
  CHECK(html.find("id=\"scene\"") == std::string::npos);
  CHECK(html.size() < 40'000);  // nor the libraries
}

TEST_CASE("base64") {
  const auto encoded = [](const std::string& s) {
    return report::data_uri("t", reinterpret_cast<const std::uint8_t*>(s.data()), s.size());
  };
  CHECK(encoded("") == "data:t;base64,");
  CHECK(encoded("f") == "data:t;base64,Zg==");
  CHECK(encoded("fo") == "data:t;base64,Zm8=");
  CHECK(encoded("foobar") == "data:t;base64,Zm9vYmFy");
}

TEST_CASE("pictures stay PNGs while they fit, and become small enough when they do not") {
  render::Image image(256, 192);
  for (int y = 0; y < 192; ++y)
    for (int x = 0; x < 256; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(x * 7), static_cast<std::uint8_t>(x * y),
                        static_cast<std::uint8_t>(y * 5)};
  const std::vector<report::PngBytes> pngs(3, render::encode_png(image));
  const report::InlinedImages whole = report::inline_pngs(pngs);
  CHECK(whole.note.empty());
  REQUIRE(whole.uris.size() == 3);
  CHECK(whole.uris[0].rfind("data:image/png", 0) == 0);
  const std::size_t budget = 30'000;
  const report::InlinedImages small = report::inline_pngs(pngs, budget);
  CHECK_FALSE(small.note.empty());
  CHECK(small.uris[0].rfind("data:image/jpeg", 0) == 0);
  CHECK(small.uris[0].size() * 3 <= budget);
}
