// lrbscope points: output and errors.
#include <array>
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"
#include "tests/support/pixels.hpp"

namespace lrb::test {
namespace {

using Json = nlohmann::json;

TEST_CASE("points: signed intervals, sides and closest points") {
  Command command({"--quiet", "points", "cube.obj"});
  command.folder.write("points.csv", "x,y,z\n0.5,0.5,0.75\n4,0.5,5\n1,0.5,0.5 # on the surface\n\n");
  const auto lines = command.lines({"points.csv"});
  REQUIRE(lines.size() == 3);
  const double expected[] = {-0.25, 5, 0};
  const char* const sides[] = {"inside", "outside", "on the surface"};
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    CHECK(lines[i]["point"] == i);
    CHECK(lines[i]["lower"].get<double>() <= expected[i]);
    CHECK(lines[i]["upper"].get<double>() >= expected[i]);
    CHECK(lines[i]["upper"].get<double>() - lines[i]["lower"].get<double>() < 1e-11);
    CHECK(lines[i]["side"] == sides[i]);
  }
  CHECK(lines[0]["closest"] == Json({0.5, 0.5, 1.0}));
  CHECK(lines[1]["feature"] == "edge");
  CHECK(lines[1]["vertices"].size() == 2);
  CHECK(lines == command.lines({"points.csv", "--threads", "2"}));
  CHECK(command.lines({"points.csv", "--tolerance", "2"})[1]["upper"].get<double>() <= 7);
}

TEST_CASE("points: a body that is not closed has no inside, and the command says so") {
  Command command({"points", "open.obj"});
  command.folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  command.folder.write("points.txt", "0.25 0.25 -2\n");
  const Outcome o = command.run({"points.txt"});
  CHECK(o.code == 0);
  CHECK(o.err.find("the body is not closed") != std::string::npos);
  const Json line = Json::parse(o.out);
  CHECK(line["side"].is_null());
  CHECK(line["lower"].get<double>() == doctest::Approx(2));
}

TEST_CASE("points: more than a batch of points, in their order") {
  Command command({"--quiet", "points", "cube.obj"});
  std::string text;
  for (int i = 0; i < 5000; ++i) text += "0.5 0.5 " + std::to_string(i + 2) + "\n";
  command.folder.write("points.txt", text);
  const auto lines = command.lines({"points.txt"});
  REQUIRE(lines.size() == 5000);
  for (std::size_t i = 0; i < lines.size(); i += 499)
    CHECK(lines[i]["upper"].get<double>() == doctest::Approx(static_cast<double>(i + 1)));
}

TEST_CASE("points: a picture, with points in the colours of their sides") {
  Command command({"--quiet", "points"});
  command.folder.write("points.txt", "0.5 0.5 0.5\n2 0.5 0.5\n0.5 1 0.5\n0 0 3\n");
  command.folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_mesh(shapes::star(5), command.folder / "star.obj");
  const auto colours = [&](const std::string& body) {
    const std::vector<std::string> draw = {"points.txt", "--draw", "out.png", "--size", "640x400"};
    const render::Image image = drawn(command.folder, "out.png", command.with({body}), draw).image;
    CHECK(image.rect() == render::PixelRect{0, 0, 640, 400});
    std::array<bool, 2> found{};
    for (const std::size_t i : {0U, 1U}) {
      const render::Rgba colour = i == 0 ? render::palette::kContact : render::palette::kGreen;
      found[i] = count_pixels(image, {0, 0.15, 1, 0.85}, [&](render::Rgba c) { return c == colour; }) > 0;
    }
    return found;
  };
  CHECK(colours("cube.obj") == std::array{true, true});    // inside, on the surface
  CHECK(colours("star.obj") == std::array{true, false});   // in the plane, z is ignored
  CHECK(colours("open.obj") == std::array{false, false});  // neither
}

TEST_CASE("points: invalid input is rejected in one line") {
  Command command({"points"});
  command.folder.write("points.txt", "0 0 0\n");
  command.folder.write("bad.txt", "0 0 0\n1 2\n");
  command.folder.write("nan.txt", "0 0 nan\n");
  command.folder.write("none.txt", "# no points\n");
  command.folder.write("empty.obj", "v 0 0 0\n");
  command.check_refusals(
      {{{"cube.obj", "none.obj"}, "none.obj"},
       {{"cube.obj", "bad.txt"}, "bad.txt:2: expected 3 numbers (x, y and z of a point), found 2"},
       {{"cube.obj", "nan.txt"}, "nan.txt:1: \"nan\" is not finite"},
       {{"cube.obj", "none.txt"}, "none.txt: no points"},
       {{"empty.obj", "points.txt"}, "empty.obj"},
       {{"cube.obj", "points.txt", "--tolerance", "-1"}, "tolerance"},
       {{"cube.obj", "points.txt", "--draw", "a.png", "--size", "640"}, "--size: expected"}});
}

}  // namespace
}  // namespace lrb::test
