// lrbscope near: output, pictures and errors.
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"
#include "tests/support/pixels.hpp"

namespace lrb::test {
namespace {

using Json = nlohmann::json;

/// A cube and a small one: 0.25 from three faces of the cube, from inside; and 1.5 apart.
struct NearCommand : Command {
  NearCommand() : Command({"--quiet", "near", "cube.obj", "small.obj", "--poses", "poses.txt"}) {
    folder.write("poses.txt", "1 0 0 0  0 1 0 0  0 0 1 0\n1 0 0 2.25  0 1 0 0  0 0 1 0\n");
    folder.write("one.txt", "1 0 0 2.25  0 1 0 0  0 0 1 0\n");
  }
};

TEST_CASE("near: the pairs within a distance, with intervals and closest points") {
  const NearCommand c;
  const auto lines = c.lines({"--within", "1.5"});
  REQUIRE(lines.size() == 2);
  CHECK(lines[0]["found"].get<int>() > lines[1]["found"].get<int>());
  REQUIRE(lines[1]["found"] == 18);  // of the two opposite sides, and triangles that share an edge with them
  for (const Json& pair : lines[1]["pairs"]) {
    CHECK(pair["meet"] == "disjoint");
    CHECK(pair["lower"].get<double>() <= 1.5);
    CHECK(pair["upper"] == 1.5);
    CHECK(pair["faces"][0] == pair["triangles"][0].get<int>() / 2);  // quads
    CHECK(pair["faces"][1] == pair["triangles"][1]);
    CHECK(pair["point_a"][0] == 1.0);
    CHECK(pair["point_b"][0] == 2.5);
  }
  CHECK(c.lines({"--within", "1.4999999999999998"})[1] ==
        Json({{"pose", 1}, {"found", 0}, {"pairs", Json::array()}}));
}

TEST_CASE("near: the nearest pairs, in ascending order") {
  const NearCommand c;
  const Json all = c.lines({"--within", "0.5"})[0],
             nearest = c.lines({"--within", "0.5", "--nearest", "3"})[0];
  CHECK(nearest["found"] == all["found"]);
  REQUIRE(nearest["pairs"].size() == 3);
  double last = 0;
  for (const Json& pair : nearest["pairs"]) {
    CHECK(pair["lower"].get<double>() >= last);
    last = pair["lower"];
    CHECK(last == doctest::Approx(0.25));
  }
}

TEST_CASE("near: within 0, the pairs of query --pairs") {
  const NearCommand c;
  c.folder.write("through.txt", "1 0 0 0.6  0 1 0 0.6  0 0 1 0.6\n");
  const std::vector<std::string> bodies = {"cube.obj", "small.obj", "--poses", "through.txt"};
  std::vector<std::string> query = {"--quiet", "query"}, near = {"--quiet", "near"};
  query.insert(query.end(), bodies.begin(), bodies.end());
  near.insert(near.end(), bodies.begin(), bodies.end());
  query.push_back("--pairs");
  near.insert(near.end(), {"--within", "0"});
  const Json expected = lines_of(c.folder, query)[0]["list"], found = lines_of(c.folder, near)[0]["pairs"];
  REQUIRE(found.size() == expected.size());
  REQUIRE(!found.empty());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i]["triangles"] == expected[i]);
    CHECK(found[i]["meet"] != "disjoint");
    CHECK(found[i]["upper"] == 0.0);
    CHECK(found[i]["point_a"] == found[i]["point_b"]);
  }
}

TEST_CASE("near: pictures, also in 2D") {
  const NearCommand c;
  c.lines({"--within", "1.5", "--draw", "near.png", "--size", "640x400"});
  write_mesh(shapes::star(5), c.folder / "star.obj");
  lines_of(c.folder, {"-q", "near", "star.obj", "star.obj", "--poses", "one.txt", "--within", "1", "--draw",
                      "star.png"});
  for (const char* name : {"near-0.png", "near-1.png", "star.png"}) {
    CAPTURE(std::string(name));
    const render::Image image = render::read_png(c.folder / name).image;
    CHECK(count_pixels(image, {}, is_painted) > image.pixels().size() / 50);
  }
}

TEST_CASE("near: invalid input is rejected in one line") {
  const NearCommand c;
  c.folder.write("empty.obj", "v 0 0 0\n");
  c.check_refusals({{{}, "--within"},
                    {{"--within", "-1"}, "-1"},
                    {{"--within", "nan"}, "nan"},
                    {{"--within", "inf"}, "inf"},
                    {{"--within", "2", "--max-pairs", "3"}, "poses.txt:1: "},
                    {{"--within", "2", "--max-pairs", "0"}, "--max-pairs"},
                    {{"--within", "2", "--nearest", "0"}, "--nearest"}});
}

}  // namespace
}  // namespace lrb::test
