#include "bench/stability/stability_report.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "bench/stability/case_meshes.hpp"
#include "bench/stability/case_picture.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/chart.hpp"
#include "tests/stability/made_up_grid.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>

using namespace lrb;
using namespace lrb::stability;

namespace {

/// For one test: another gnuplot, or none.
struct GnuplotIs {
  explicit GnuplotIs(const char* program) { setenv("LRB_GNUPLOT", program, 1); }
  ~GnuplotIs() { unsetenv("LRB_GNUPLOT"); }
};

}  // namespace

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

TEST_CASE("without gnuplot the page is written, with one line on the missing program") {
  const GnuplotIs none("lrbscope-has-no-such-program");
  const test::Folder files;
  const std::string folder = files.path.string();
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
  const test::Folder files;
  const std::string folder = files.path.string();
  Grid grid = made_up_grid();
  grid.methods[0].title = "it's `touch " + folder + "/ran` <& @x $y \\n \"q\" ";
  grid.families[0].name = "`touch " + folder + "/ran`'; system('touch " + folder + "/ran')";
  CHECK(write_stability_report(grid, folder).notes().empty());
  CHECK_FALSE(std::filesystem::exists(folder + "/ran"));
  const std::string svg = io::read_text(folder + "/stability-profiles.svg");
  CHECK(svg.find("&lt;&amp;") != std::string::npos);
  CHECK(svg.find("coplanar") != std::string::npos);
  CHECK(render::read_png(folder + "/stability-profiles.png").image.width() > 500);
  CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 4);  // nothing is left behind
}

TEST_CASE("gnuplot's error is reported in one line" * doctest::skip(!report::has_gnuplot())) {
  const test::Folder files;
  const std::string path = files / "chart.svg";
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

TEST_CASE("the place of a pair: where its triangles cross, or the closest points; the worst kind of pairs") {
  const auto triangle = [](const std::vector<Eigen::Vector3d>& corners) {
    Mesh m;
    m.vertices = corners;
    const VertexId all[3] = {VertexId(0), VertexId(1), VertexId(2)};
    m.add_face(all);
    return cases::body(m);
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
