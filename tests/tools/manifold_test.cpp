// lrbscope manifold: output, ids, pictures and errors.
#include <set>
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"
#include "tests/support/pixels.hpp"

namespace lrb::test {
namespace {

using Json = nlohmann::json;

/// A small cube on the upper face of a cube: 0.0625 deep, moved along the face, and 0.0625 above it.
struct ManifoldCommand : Command {
  ManifoldCommand() : Command({"--quiet", "manifold", "cube.obj", "upper.obj", "--poses", "poses.txt"}) {
    write_mesh(shapes::quad_box({0.25, 0.25, 1}, {0.75, 0.75, 1.5}), folder / "upper.obj");
    folder.write("poses.txt",
                 "1 0 0 0  0 1 0 0  0 0 1 -0.0625\n1 0 0 0.001  0 1 0 0  0 0 1 -0.0625\n"
                 "1 0 0 0.002  0 1 0 0  0 0 1 0.0625\n");
    folder.write("one.txt", "1 0 0 0.5  0 1 0 0  0 0 1 0\n");
  }
};

TEST_CASE("manifold: four corners with normal, depth and features; ids persist from pose to pose") {
  const ManifoldCommand c;
  const auto lines = c.lines({"--margin", "0.125"});
  REQUIRE(lines.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    CHECK(lines[i]["pose"] == i);
    REQUIRE(lines[i]["manifolds"].size() == 1);
    const Json& m = lines[i]["manifolds"][0];
    CHECK(m["region"] == 0);
    CHECK(m["intersects"] == (i < 2));
    CHECK(m["normal"] == Json({0.0, 0.0, 1.0}));
    REQUIRE(m["points"].size() == 4);
    std::set<int> ids, vertices;
    for (const Json& p : m["points"]) {
      ids.insert(p["id"].get<int>());
      vertices.insert(p["on_b"]["vertex"].get<int>());
      CHECK(p["depth"] == (i < 2 ? 0.0625 : -0.0625));
      CHECK(p["point_a"][2] == 1.0);
      CHECK(p["point_b"][2] == (i < 2 ? 0.9375 : 1.0625));
    }
    CHECK(ids == std::set<int>{0, 1, 2, 3});
    CHECK(vertices.size() == 4);
  }
  // Without a margin, only pairs that intersect.
  const auto met = c.lines({"--pairs"});
  CHECK(met[2]["manifolds"].empty());
  CHECK(met[2]["pairs"] == 0);
  CHECK(met[0]["manifolds"][0]["list"].size() == met[0]["pairs"]);
}

TEST_CASE("manifold: pictures, also in 2D") {
  const ManifoldCommand c;
  c.lines({"--margin", "0.125", "--draw", "m.png", "--size", "640x400"});
  write_mesh(shapes::star(5), c.folder / "star.obj");
  const auto flat = lines_of(
      c.folder, {"-q", "manifold", "star.obj", "star.obj", "--poses", "one.txt", "--draw", "star.png"});
  CHECK(!flat[0]["manifolds"].empty());
  for (const char* name : {"m-0.png", "m-2.png", "star.png"}) {
    CAPTURE(std::string(name));
    const render::Image image = render::read_png(c.folder / name).image;
    CHECK(count_pixels(image, {}, is_painted) > image.pixels().size() / 50);
  }
}

TEST_CASE("manifold: invalid input is rejected in one line") {
  const ManifoldCommand c;
  c.check_refusals({{{"--margin", "-1"}, "margin"},
                    {{"--margin", "nan"}, "nan"},
                    {{"--margin", "inf"}, "inf"},
                    {{"--max-pairs", "3"}, "poses.txt:1: "},
                    {{"--max-pairs", "0"}, "--max-pairs"}});
}

}  // namespace
}  // namespace lrb::test
