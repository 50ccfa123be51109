// lrbscope inspect --self-intersections: lines, picture and errors.
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"
#include "tests/support/pixels.hpp"

namespace lrb::test {
namespace {

using Json = nlohmann::json;

/// Two boxes that cross, both twice, and crossing segments in the plane.
struct CrossingMeshes : Command {
  CrossingMeshes() : Command({"--quiet", "inspect", "--self-intersections"}) {
    const Mesh crossing = shapes::several({shapes::box(), shapes::box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5})});
    write_mesh(crossing, folder / "crossing.obj");
    write_mesh(shapes::several({crossing, shapes::translated(crossing, {4, 0, 0})}), folder / "twice.obj");
    folder.write("plane.obj", "v 0 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nl 1 2\nl 3 4\n");
  }
  std::vector<Json> pairs(const std::string& file, const std::vector<std::string>& more = {}) const {
    const Outcome o = run(joined({file}, more));
    CAPTURE(o.err);
    std::vector<Json> out = json_lines(o.out);
    CHECK(o.code == (out.empty() ? 0 : 1));
    return out;
  }
};

TEST_CASE("self-intersections: pairs, curves, and the exit code") {
  const CrossingMeshes c;
  CHECK(c.pairs("cube.obj").empty());
  const auto once = c.pairs("crossing.obj"), twice = c.pairs("twice.obj");
  CHECK_FALSE(once.empty());
  CHECK(twice.size() == 2 * once.size());
  for (const Json& pair : once) CHECK(pair["curve"] == 0);
  CHECK(twice.back()["curve"] == 1);
  CHECK(c.pairs("plane.obj").size() == 1);
}

TEST_CASE("self-intersections: a picture, also of bodies without any") {
  const CrossingMeshes c;
  for (const std::string name : {"twice", "plane", "cube"}) {
    CAPTURE(name);
    c.pairs(name + ".obj", {"--draw", name + ".png", "--size", "640x400"});
    const render::Image image = render::read_png(c.folder / (name + ".png")).image;
    CHECK(image.rect() == render::PixelRect{0, 0, 640, 400});
    CHECK(count_pixels(image, {}, is_painted) > image.pixels().size() / 50);
  }
}

TEST_CASE("self-intersections: those of an .lrb are those of its mesh") {
  const CrossingMeshes c;
  CHECK(test::run(c.folder, {"--quiet", "build", "crossing.obj", "-o", "crossing.lrb"}).code == 0);
  CHECK(c.pairs("crossing.obj", {"--draw", "a.png"}) == c.pairs("crossing.lrb", {"--draw", "b.png"}));
  CHECK(render::read_png(c.folder / "a.png").image.pixels().size() ==
        render::read_png(c.folder / "b.png").image.pixels().size());
}

TEST_CASE("self-intersections: invalid options are rejected in one line") {
  const CrossingMeshes c;
  c.check_refusals({{{"crossing.obj", "--size", "640x400"}, "--size: needs --render or --draw"},
                    {{"crossing.obj", "--draw", "a.png", "--size", "640"}, "--size: expected"},
                    {{"plane.obj", "--draw", "a.png", "--from", "1,0,0"}, "2D"},
                    {{"none.obj", "--draw", "a.png"}, "none.obj"}});
}

}  // namespace
}  // namespace lrb::test
