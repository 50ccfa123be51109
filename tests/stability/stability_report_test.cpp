#include "bench/stability/stability_report.hpp"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <doctest/doctest.h>

#include "bench/stability/case_meshes.hpp"
#include "bench/stability/case_picture.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/chart.hpp"
#include "tests/stability/made_up_grid.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

using namespace lrb;
using lrb::test::count;
using namespace lrb::stability;

namespace {

std::string scratch_folder(const std::string& name) {
  static const test::Folder all;
  const auto path = all.path / name;
  std::filesystem::create_directories(path);
  return path.string();
}

/// Names an element that is not closed in order; empty: all are.
std::string unbalanced(const std::string& markup) {
  static const std::set<std::string> kVoid = {"meta", "link", "img", "br", "input", "wbr"};
  std::vector<std::string> open;
  std::size_t at = 0;
  while ((at = markup.find('<', at)) != std::string::npos) {
    std::size_t end = at + 1;
    for (char quote = 0; end < markup.size() && (quote != 0 || markup[end] != '>'); ++end)
      if (quote != 0 ? markup[end] == quote : markup[end] == '"') quote = quote != 0 ? 0 : '"';
    const std::string tag = markup.substr(at + 1, end - at - 1);
    at = end;
    if (tag[0] == '!' || tag[0] == '?') continue;
    const std::string name =
        tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" \n\t/>", 1) - (tag[0] == '/' ? 1 : 0));
    if (tag[0] == '/') {
      if (open.empty() || open.back() != name) return "/" + name;
      open.pop_back();
    } else if (tag.back() != '/' && !kVoid.contains(name)) {
      open.push_back(name);
      // The content of these is not markup.
      if (name == "script" || name == "style") at = markup.find("</" + name, at);
    }
  }
  return open.empty() ? "" : open.back();
}

std::map<std::uint32_t, int> colours(const render::Image& image) {
  std::map<std::uint32_t, int> out;
  for (const render::Rgba& p : image.pixels()) ++out[(p.r << 16U) | (p.g << 8U) | p.b];
  return out;
}

/// Pixels of exactly this colour below the title and above the legend.
int pixels_of(const render::Image& image, render::Rgba c) {
  render::Image inner(image.width(), image.height() - 180);
  for (int y = 0; y < inner.height(); ++y)
    for (int x = 0; x < image.width(); ++x) inner.at(x, y) = image.at(x, y + 90);
  return colours(inner)[(c.r << 16U) | (c.g << 8U) | c.b];
}

cases::Body made(const Mesh& mesh) {
  return cases::body(mesh);
}

cases::Case boxes(double scale = 1, const Eigen::Vector3d& by = Eigen::Vector3d::Zero()) {
  cases::Case c;
  c.a = made(shapes::scaled(shapes::box(), scale));
  c.b = made(shapes::scaled(shapes::l_shape(), scale));
  c.pose_a = Pose::translation(by);
  c.pose_b = Pose::translation(by + scale * Eigen::Vector3d(0.5, 0.25, 0.75));
  return c;
}

render::Image picture(const cases::Case& c, std::size_t drop = 2, bool with_extra = true) {
  static render::Rasterizer rasterizer;
  const std::vector<SimplexPair> expected = brute_force(*c.a, c.pose_a, *c.b, c.pose_b).pairs;
  REQUIRE(expected.size() > drop);
  std::vector<SimplexPair> answered(expected.begin() + static_cast<std::ptrdiff_t>(drop), expected.end());
  const std::set<SimplexPair> known(expected.begin(), expected.end());
  for (SimplexId a = 0; with_extra && a < c.a->real_simplex_count(); ++a)
    if (!known.contains({a, 1})) {
      answered.push_back({a, 1});
      break;
    }
  return worst_case_picture(c, expected, answered, {"title", "wrong", {}}, rasterizer);
}

/// Share of pixels that clearly differ.
double differing(const render::Image& a, const render::Image& b) {
  REQUIRE(a.pixels().size() == b.pixels().size());
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    const render::Rgba p = a.pixels()[i], q = b.pixels()[i];
    n += std::abs(p.r - q.r) + std::abs(p.g - q.g) + std::abs(p.b - q.b) > 60;
  }
  return static_cast<double>(n) / static_cast<double>(a.pixels().size());
}

/// For one test: another gnuplot, or none.
struct GnuplotIs {
  explicit GnuplotIs(const char* program) { setenv("LRB_GNUPLOT", program, 1); }
  ~GnuplotIs() { unsetenv("LRB_GNUPLOT"); }
};

}  // namespace

TEST_CASE("the page is complete and self-contained") {
  const std::string folder = scratch_folder("page");
  const Grid grid = made_up_grid();
  ReportOptions options;
  options.command = [](const Record& r) { return "show <" + r.family + ">"; };
  options.pictures.resize(grid.cells.size());
  render::write_png(render::Image(8, 8, render::palette::kBlue), folder + "/first.png");
  options.pictures[1] = "first.png";
  const std::string html = stability_page(grid, folder, options).html();
  CHECK(unbalanced(html) == "");
  CHECK(html.find("http:") == std::string::npos);
  CHECK(html.find("https:") == std::string::npos);
  CHECK(html.find("@import") == std::string::npos);
  CHECK_FALSE(std::regex_search(html, std::regex("url\\(")));
  CHECK(count(html, "<img src=\"data:image/png;base64,") == 1);
  CHECK(count(html, "<img src=") == 1);
}

TEST_CASE("names are escaped, and their addresses are plain") {
  Grid grid = made_up_grid();
  grid.methods[1].name = "a\"><script>x";
  grid.methods[1].title = "<script>alert(1)</script>";
  const std::string html = stability_page(grid, ".", {}).html();
  CHECK(html.find("<script>alert") == std::string::npos);
  CHECK(html.find("<b>&\"quoted\"") == std::string::npos);
  CHECK(html.find("&lt;b&gt;&amp;") != std::string::npos);
  CHECK(unbalanced(html) == "");
  const std::regex sheet("<dialog [^>]*id=\"([^\"]*)\"");
  for (std::sregex_iterator i(html.begin(), html.end(), sheet), end; i != end; ++i)
    CHECK(std::regex_match((*i)[1].str(), std::regex("[A-Za-z0-9-]+")));
}

TEST_CASE("rejections are not failures, and the first failing difficulty is found") {
  Cell c;
  c.of(Outcome::right).fill(10);
  c.of(Outcome::right)[3] = 0;
  c.of(Outcome::rejected)[3] = 10;
  CHECK(c.failures() == 0);
  CHECK(c.only_rejected());
  c.of(Outcome::timed_out)[7] = 1;
  c.of(Outcome::crashed)[9] = 2;
  c.of(Outcome::wrong)[10] = 3;
  CHECK(c.failures() == 6);
  CHECK(c.first_failing() == 7);
  CHECK(c.level() == 2);
  CHECK_FALSE(c.only_rejected());
}

TEST_CASE("an inconsistent grid is rejected") {
  Grid grid = made_up_grid();
  grid.cells.pop_back();
  CHECK_THROWS_AS(stability_page(grid, ".", {}), InputError);
}

TEST_CASE("without gnuplot the page is written, with one line on the missing program") {
  const GnuplotIs none("lrbscope-has-no-such-program");
  const std::string folder = scratch_folder("no_gnuplot");
  const report::Document page = write_stability_report(made_up_grid(), folder);
  CHECK(page.written() == std::vector<std::string>{"index.html", "grid.csv"});
  REQUIRE(page.notes().size() == 1);
  CHECK(page.notes()[0].find("gnuplot-nox") != std::string::npos);
  CHECK(page.notes()[0].find('\n') == std::string::npos);
  CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 2);
  CHECK_FALSE(report::has_gnuplot());
}

TEST_CASE("charts are drawn, and their texts are not run as commands" *
          doctest::skip(!report::has_gnuplot())) {
  const std::string folder = scratch_folder("charts");
  Grid grid = made_up_grid();
  grid.methods[0].title = "it's `touch " + folder + "/ran` <& @x $y \\n \"q\" ";
  grid.families[0].name = "`touch " + folder + "/ran`'; system('touch " + folder + "/ran')";
  CHECK(write_stability_report(grid, folder).notes().empty());
  CHECK_FALSE(std::filesystem::exists(folder + "/ran"));
  for (const char* name : {"stability.svg", "stability-profiles.svg"}) {
    const std::string svg = io::read_text(folder + "/" + name);
    CHECK(unbalanced(svg) == "");
    CHECK(svg.find("&lt;&amp;") != std::string::npos);
    CHECK(svg.find("coplanar") != std::string::npos);
  }
  const std::string svg = io::read_text(folder + "/stability.svg");
  CHECK(count(svg, "not installed here: bullet") == 1);
  // A crash, a time-out and a refusal have their marks.
  for (const char* mark : {"\u2715", "\u25f7", "\u2298"}) CHECK(count(svg, mark) > 1);
  const render::Image png = render::read_png(folder + "/stability.png").image;
  CHECK(png.width() > 1500);
  const auto found = colours(png);
  CHECK(found.contains(0xd55e00));
  CHECK(found.contains(0x14161a));
  CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 6);  // nothing is left behind
}

TEST_CASE("gnuplot's error is reported in one line" * doctest::skip(!report::has_gnuplot())) {
  const std::string path = scratch_folder("complaint") + "/chart.svg";
  report::Gnuplot chart;
  chart.script = "plot nonsense(\n";
  try {
    report::draw(chart, path);
    FAIL("no error");
  } catch (const EnvironmentError& e) {
    CHECK(std::string(e.what()).find("chart.svg") != std::string::npos);
    CHECK(std::string(e.what()).find('\n') == std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(path));
  chart.script = "plot x\n";
  CHECK_THROWS_AS(report::draw(chart, path + ".gif"), InputError);
}

TEST_CASE("a 2D picture has exactly the colours of its marks") {
  cases::Case c;
  c.a = made(shapes::l_shape_2d());
  c.b = c.a;
  c.pose_b = Pose::translation({0.5, 0.25, 0});
  const render::Image all = picture(c, 1, true);
  CHECK(pixels_of(all, colour_of(Mark::found)) > 100);
  CHECK(pixels_of(all, colour_of(Mark::missed)) > 100);
  CHECK(pixels_of(all, colour_of(Mark::extra)) > 100);
  const render::Image right = picture(c, 0, false);
  CHECK(pixels_of(right, colour_of(Mark::found)) > 100);
  CHECK(pixels_of(right, colour_of(Mark::missed)) == 0);
  CHECK(pixels_of(right, colour_of(Mark::extra)) == 0);
}

TEST_CASE("the picture does not depend on scale and position of the world") {
  const render::Image here = picture(boxes());
  CHECK(here == picture(boxes(0x1p-400)));
  CHECK(here == picture(boxes(0x1p900)));
  // Far away the close-up's box is rounded: edges may move by a fraction of a pixel.
  CHECK(differing(here, picture(boxes(1, {0x1p40, -0x1p40, 0x1p30}))) < 0.002);
  CHECK(differing(here, picture(boxes(), 3)) > 0.01);
}

TEST_CASE("the place of a pair: where its triangles cross, or the closest points; the worst kind of pairs") {
  const auto triangle = [](const std::vector<Eigen::Vector3d>& corners) {
    Mesh m;
    m.vertices = corners;
    const VertexId all[3] = {VertexId(0), VertexId(1), VertexId(2)};
    m.add_face(all);
    return made(m);
  };
  cases::Case c;
  c.a = triangle({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  c.b = triangle({{0.25, 0.25, -1}, {0.25, 0.25, 1}, {2, 2, 1}});
  const SimplexPair pair = {SimplexId(0), SimplexId(0)};
  const Corners crossing = PosedPair(c, pair).place();
  REQUIRE(crossing.size() == 2);
  const Eigen::Vector3d end(0.25, 0.25, 0);
  CHECK((crossing[0] == end || crossing[1] == end));
  c.pose_b = Pose::translation({0, 0, 1.5});
  CHECK(PosedPair(c, pair).place() == Corners{{0.25, 0.25, 0}, {0.25, 0.25, 0.5}});  // closest points
  CHECK(compare(Pairs{pair}, Pairs{}).mark() == Mark::missed);
  CHECK(compare({}, Pairs{pair}).mark() == Mark::extra);
}

TEST_CASE("cases that cannot be drawn are rejected") {
  render::Rasterizer rasterizer;
  cases::Case c = boxes();
  c.pose_a.t.x() = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(worst_case_picture(c, {}, std::nullopt, {}, rasterizer), InputError);
  c = boxes();
  const std::vector<SimplexPair> wild = {{0, 99999}};
  CHECK_THROWS_AS(worst_case_picture(c, wild, std::nullopt, {}, rasterizer), InputError);
}

TEST_CASE("every failed cell gets a picture, and old pictures are removed") {
  const std::string folder = scratch_folder("worst");
  std::filesystem::create_directories(folder + "/worst");
  io::write_text(folder + "/worst/of-an-earlier-run.png", "old");
  Grid grid = made_up_grid();
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    if (i / grid.methods.size() > 2) grid.cells[i].worst.reset();  // few are enough
  grid.cells[1].worst->family = "unknown";
  std::size_t checked = 0;
  const std::vector<std::string> pictures = draw_worst_cases(grid, folder, [&](const Record& r) {
    ++checked;
    const cases::Case c = cases::make_case(*cases::find_family(r.family), r.seed, r.difficulty, r.case_index);
    return Replay{{}, brute_force(*c.a, c.pose_a, *c.b, c.pose_b).pairs, Pairs{}};
  });
  REQUIRE(pictures.size() == grid.cells.size());
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    CHECK(pictures[i].empty() == (!grid.cells[i].worst || i == 1));
    if (!pictures[i].empty()) CHECK(render::read_png(folder + "/" + pictures[i]).image.width() > 1000);
    drawn += pictures[i].empty() ? 0 : 1;
  }
  CHECK(drawn > 5);
  CHECK(checked == drawn);
  CHECK_FALSE(std::filesystem::exists(folder + "/worst/of-an-earlier-run.png"));
}

TEST_CASE("every family's cases can be drawn at the lowest and highest difficulty") {
  render::Rasterizer rasterizer;
  for (const cases::Family& family : cases::all_families())
    for (const int difficulty : {0, cases::kDifficulties - 1}) {
      CAPTURE(family.name);
      const cases::Case c = cases::make_case(family, 5, difficulty, 0);
      std::vector<SimplexPair> pairs;
      bool drawable = true;
      try {
        pairs = brute_force(*c.a, c.pose_a, *c.b, c.pose_b).pairs;
      } catch (const InputError&) {
        drawable = false;  // beyond the range of coordinates: a refusal, drawn if its vertices are finite
      }
      const auto draw_it = [&] {
        return worst_case_picture(c, pairs, std::nullopt, {"t", "", {}}, rasterizer);
      };
      if (drawable)
        CHECK_NOTHROW(draw_it());
      else
        try {
          draw_it();
        } catch (const InputError&) {
        }
    }
}

TEST_CASE("a case is determined by seed, index and difficulty") {
  const cases::Family& family = *cases::find_family("sliver");
  const auto hash = [&](std::uint64_t seed, int difficulty, std::uint64_t index) {
    const cases::Case c = cases::make_case(family, seed, difficulty, index);
    return std::pair(c.a->hash() ^ c.b->hash(), c.pose_b.t.x());
  };
  CHECK(hash(1, 4, 7) == hash(1, 4, 7));
  CHECK(hash(1, 4, 7) != hash(2, 4, 7));
  CHECK(hash(1, 4, 7) != hash(1, 4, 8));
  CHECK(hash(1, 4, 7) != hash(1, 5, 7));
  CHECK_THROWS_AS(cases::make_case(family, 1, cases::kDifficulties, 0), InputError);
  CHECK_THROWS_AS(cases::make_case(family, 1, -1, 0), InputError);
}
