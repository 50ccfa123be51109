// Pictures and charts of distance, sweep and clash, and what query adds of them.
#include <string>

#include <doctest/doctest.h>

#include "scenarios/report/chart.hpp"
#include "tests/support/command.hpp"
#include "tests/support/pixels.hpp"

namespace lrb::test {
namespace {

using Json = nlohmann::json;

/// A cube and a smaller one: 2 away, in a corner of the cube, held, and touching it with a face.
struct TwoCubes : Command {
  TwoCubes() : Command({"-q"}) {
    write_mesh(shapes::star(5), folder / "star.obj");
    folder.write("poses.txt",
                 "1 0 0 2.75  0 1 0 0  0 0 1 0\n1 0 0 0.6  0 1 0 0.6  0 0 1 0.6\n"
                 "1 0 0 0  0 1 0 0  0 0 1 0\n1 0 0 0.75  0 1 0 0  0 0 1 0\n");
    folder.write("beside.txt", "1 0 0 3  0 1 0 0  0 0 1 0\n");
    folder.write("motions.txt", "1 0 0 2.75 0 1 0 0 0 0 1 0   1 0 0 -2 0 1 0 0 0 0 1 0\n");
  }
  std::vector<Json> ask(const std::string& command, std::vector<std::string> more = {}) const {
    const bool moves = command == "sweep";
    more.insert(more.begin(), {command, "cube.obj", "small.obj", moves ? "--motions" : "--poses",
                               moves ? "motions.txt" : "poses.txt"});
    return lines(more);
  }
  /// Returns true if there is a picture, in which bodies cover a good part.
  bool has_png(const std::string& name) const {
    const render::Image image = render::read_png(folder / name).image;
    return count_pixels(image, {}, is_painted) > image.pixels().size() / 50;
  }
};

TEST_CASE("draw: a picture for each answer, numbered if there are several") {
  const TwoCubes c;
  c.ask("distance", {"--draw", "gap.png"});
  c.ask("clash", {"--draw", "clash.png"});
  c.ask("sweep", {"--draw", "met.png"});
  for (const char* name : {"gap-0.png", "gap-1.png", "gap-2.png", "gap-3.png", "clash-0.png", "clash-1.png",
                           "clash-2.png", "clash-3.png", "met.png"}) {
    CAPTURE(std::string(name));
    CHECK(c.has_png(name));
  }
}

TEST_CASE("draw: 2D bodies") {
  const TwoCubes c;
  c.lines({"distance", "star.obj", "star.obj", "--poses", "beside.txt", "--draw", "gap.png"});
  c.folder.write("way.txt", "1 0 0 4 0 1 0 0.3 0 0 1 0   1 0 0 -4 0 1 0 0.3 0 0 1 0\n");
  c.lines({"sweep", "star.obj", "star.obj", "--motions", "way.txt", "--draw", "met.png"});
  CHECK(c.has_png("gap.png"));
  CHECK(c.has_png("met.png"));
}

TEST_CASE("draw: pictures of the requested size, other sizes are rejected") {
  const TwoCubes c;
  c.lines({"distance", "star.obj", "star.obj", "--poses", "beside.txt", "--draw", "small.png", "--size",
           "640x400", "--up", "y"});
  CHECK(render::read_png(c.folder / "small.png").image.rect() == render::PixelRect{0, 0, 640, 400});
  c.check_refusals(
      {{{"distance", "star.obj", "star.obj", "--poses", "beside.txt", "--draw", "no.png", "--size", "640"},
        "--size: expected WIDTHxHEIGHT"}});
}

TEST_CASE("convergence: the history of bounds in the line") {
  const TwoCubes c;
  const auto gaps = c.ask("distance", {"--convergence"});
  REQUIRE(gaps.size() == 4);
  const Json& last = gaps[0]["course"].back();
  CHECK(last[1] == gaps[0]["lower"]);
  CHECK(last[2] == gaps[0]["upper"]);
  const auto clashes = c.ask("clash", {"--convergence"});
  CHECK(clashes[1]["course"].back()[1] == clashes[1]["depth"][0]);
  CHECK(clashes[1]["course"].back()[2] == clashes[1]["depth"][1]);
  const auto met = c.ask("sweep", {"--convergence"});
  CHECK(met[0]["course"].front()[3].get<double>() == doctest::Approx(2).epsilon(0.01));
  CHECK(met[0]["course"].back()[2] == met[0]["t1"]);
}

TEST_CASE("chart: of the bounds, by gnuplot" * doctest::skip(!report::has_gnuplot())) {
  const TwoCubes c;
  c.ask("distance", {"--chart", "gap.svg"});
  c.ask("sweep", {"--chart", "met.svg"});
  CHECK(slurp(c.folder / "gap-0.svg").find("distance, lower bound") != std::string::npos);
  CHECK(slurp(c.folder / "met.svg").find("time of impact, lower bound") != std::string::npos);
}

TEST_CASE("chart: other kinds are rejected before anything is printed") {
  const TwoCubes c;
  c.check_refusals({{{"distance", "cube.obj", "small.obj", "--poses", "poses.txt", "--chart", "gap.txt"},
                     "expected a file name that ends in .svg, .png or .pdf"}});
}

TEST_CASE("query: kind of contact and distance agree with clash and distance") {
  const TwoCubes c;
  const auto lines = c.ask("query", {"--kind", "--distance"}), plain = c.ask("query");
  const auto clashes = c.ask("clash"), gaps = c.ask("distance");
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(i);
    CHECK(lines[i]["kind"] == clashes[i]["kind"]);
    CHECK(lines[i]["distance"] == Json::array({gaps[i]["lower"], gaps[i]["upper"]}));
    CHECK(lines[i]["fingerprint"] == plain[i]["fingerprint"]);
    CHECK_FALSE(plain[i].contains("kind"));
    CHECK_FALSE(plain[i].contains("distance"));
  }
  CHECK(lines[1]["kind"] == "protrudes");
  CHECK(lines[2]["kind"] == "b_inside_a");
  CHECK(lines[3]["kind"] == "touching_face");
  const Outcome flat = c.run({"query", "star.obj", "star.obj", "--poses", "beside.txt", "--kind"});
  CHECK(flat.code == 2);
  CHECK(flat.err.find("expected 3D bodies") != std::string::npos);
}

}  // namespace
}  // namespace lrb::test
