#include <filesystem>
#include <regex>
#include <sstream>
#include <string>

#include <doctest/doctest.h>

#include "scenarios/io/files.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/report/document.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>

using namespace lrb;
using lrb::test::count;

namespace {

/// `scene`: a run for the view; empty: none.
std::string full_page(const std::string& scene = {}) {
  const test::Folder folder;
  for (const char* file : {"a.png", "b.png"}) render::write_png(render::Image(4, 4), folder / file);
  report::Document doc("A < B & \"C\" {{data}}", "</script><script>alert(1)</script>");
  doc.verdict("crossing").number({"pairs", "12", "at step 3"}).command("lrbscope run x");
  if (!scene.empty()) doc.scene(scene);
  doc.frames({{"a.png", "</script>first", 0, 0}, {"b.png", "second", 7, 1}}, folder.path.string());
  report::Chart chart{"chart", {"event"}, {"</script>faces"}, {{"s", {0, 1, 2}, {3, 4, 5}}}};
  chart.cursor = report::Cursor::event;
  doc.chart(chart).table({"table", {"a", "b"}, {{"1", "x"}}, "note"});
  return doc.link({"trace.json", "opens in Perfetto"}).html();
}

}  // namespace

TEST_CASE("a page is self-contained: no external addresses, all scripts and pictures inside") {
  std::string html = full_page();
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
  CHECK(html.find("default-src 'none'") != std::string::npos);  // and the page declares it to the browser
}

TEST_CASE("text cannot become markup or end the data") {
  const std::string html = full_page();
  CHECK(html.find("<script>alert") == std::string::npos);
  for (const char* text : {"</script>first", "</script>faces"}) CHECK(html.find(text) == std::string::npos);
  CHECK(html.find("A &lt; B &amp; &quot;C&quot; {{data}}") != std::string::npos);  // marks in texts are texts
  CHECK(count(html, "<script") == count(html, "</script>"));
}

TEST_CASE("modules import what others export") {
  const std::regex import("import \\{ (.*) \\} from \"\\./(.*)\";"), name("\\w+");
  int imports = 0;
  for (const io::EmbeddedFile& file : io::embedded_files()) {
    std::istringstream text{file.name.ends_with(".js") ? std::string(file.text) : ""};
    std::smatch parts;
    for (std::string line; std::getline(text, line);) {
      if (!line.starts_with("import ") || !std::regex_match(line, parts, import)) continue;
      const std::string names = parts[1], other(io::embedded_file(parts[2].str()));
      for (std::sregex_iterator i(names.begin(), names.end(), name), end; i != end; ++i, ++imports)
        CHECK_MESSAGE(std::regex_search(
                          other, std::regex("\nexport (async )?(class|function|const) " + i->str() + "\\b")),
                      file.name, " ", i->str());
    }
  }
  CHECK(imports > 100);
}

TEST_CASE("a document writes its page and the files that it names, and locks its folder meanwhile") {
  const test::Folder folder;
  const std::string out = folder / "out";
  report::Document doc("t");
  doc.file("a.txt", "text", "a note").picture("b.png", render::Image(2, 2), "picture", "caption").write(out);
  for (const std::string& name : doc.written()) CHECK(std::filesystem::exists(folder / ("out/" + name)));
  CHECK(doc.written() == std::vector<std::string>{"index.html", "a.txt", "b.png"});
  for (const char* part :
       {"<a href=\"a.txt\">a.txt</a> <span>a note</span>", "<a href=\"b.png\"><img src=\"data:image/png"})
    CHECK(count(io::read_text(out + "/index.html"), part) == 1);
  const report::Folder locked(out);
  CHECK_THROWS_AS(doc.write(out), EnvironmentError);
  doc.write(locked);
}

TEST_CASE("pictures stay PNGs if they fit, and are reduced otherwise") {
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
