// lrbscope clash: output and errors.
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"

namespace lrb::test {
namespace {

using Json = nlohmann::json;

struct ClashingBoxes : Command {
  ClashingBoxes() : Command({"--quiet", "clash", "cube.obj", "b.obj", "--poses", "poses.txt"}) {
    write_mesh(shapes::box({-1, 0.25, 0.25}, {0, 0.5, 0.5}), folder / "b.obj");
    // 0.25 into a side; touching it; 0.5 away; through
    folder.write("poses.txt",
                 "1 0 0 0.25  0 1 0 0  0 0 1 0\n1 0 0 0  0 1 0 0  0 0 1 0\n1 0 0 -0.5  0 1 0 0  0 0 1 0\n"
                 "3 0 0 2  0 1 0 0  0 0 1 0\n");
    folder.write("plane.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\nl 3 1\n");
  }
};

TEST_CASE("clash: a line for each pose, and a table") {
  const ClashingBoxes boxes;
  const std::vector<Json> lines = boxes.lines({"--clearance", "0.5", "--along", "-1,0,0"});
  REQUIRE(lines.size() == 4);
  const char* kinds[] = {"protrudes", "touching_face", "within_clearance", "cuts_through"};
  const double depths[] = {0.25, 0, 0, 0.5}, volumes[] = {0.015625, 0, 0, 0.0625}, ways[] = {0.25, 0, 0, 2};
  const auto holds = [](const Json& interval, double value) {
    return interval[0] <= value && interval[1] >= value &&
           interval[1].get<double>() - interval[0].get<double>() < 1e-10;
  };
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(lines[i].dump());
    CHECK(lines[i]["pose"] == i);
    CHECK(lines[i]["kind"] == kinds[i]);
    CHECK(holds(lines[i]["depth"], depths[i]));
    CHECK(holds(lines[i]["volume"], volumes[i]));
    CHECK(holds(lines[i]["along"], ways[i]));
    CHECK(holds(lines[i]["distance"], i == 2 ? 0.5 : 0));
    CHECK(lines[i].contains("pieces_a") == (i != 2));
  }
  CHECK(lines[0]["translation"][0].get<double>() == doctest::Approx(-0.25));
  const Outcome table = boxes.run({"--table"});
  REQUIRE(table.code == 0);
  CHECK(table.out.find("pose") == 0);
  CHECK(table.out.find("touching_face") != std::string::npos);
  CHECK(table.out.find("0.015625") != std::string::npos);
}

TEST_CASE("B2: clash reports why a kind is undecided, for a mesh and its .lrb") {
  ClashingBoxes boxes;
  write_mesh(shapes::several({shapes::box(), shapes::box({0.5, 0.25, 0.25}, {2, 0.75, 0.75})}),
             boxes.folder / "b.obj");
  boxes.folder.write("poses.txt", "1 0 0 0.75  0 1 0 0.125  0 0 1 0\n1 0 0 9  0 1 0 0  0 0 1 0\n");
  REQUIRE(run(boxes.folder, {"--quiet", "build", "b.obj", "-o", "b.lrb"}).code == 0);
  std::vector<Json> first;
  for (const char* const b : {"b.obj", "b.lrb"}) {
    const std::vector<Json> lines =
        lines_of(boxes.folder, {"--quiet", "clash", "cube.obj", b, "--poses", "poses.txt"});
    REQUIRE(lines.size() == 2);
    CHECK(lines[0]["kind"] == "undecided");
    CHECK(lines[0]["reason"] == "B intersects itself");
    CHECK(lines[0].contains("depth"));
    CHECK_FALSE(lines[0].contains("volume"));
    CHECK_FALSE(lines[0].contains("pieces_a"));
    CHECK(lines[1]["kind"] == "apart");
    CHECK_FALSE(lines[1].contains("reason"));
    if (first.empty()) first = lines;
    CHECK(lines == first);
    const std::vector<Json> found =
        lines_of(boxes.folder, {"--quiet", "query", "cube.obj", b, "--poses", "poses.txt", "--kind"});
    CHECK(found[0]["kind"] == "undecided");
    CHECK(found[0]["reason"] == "B intersects itself");
  }
  const Outcome table = boxes.run({"--table"});
  CHECK(table.out.find("undecided: B intersects itself") != std::string::npos);
}

TEST_CASE("clash: invalid requests are rejected in one line") {
  ClashingBoxes boxes;
  boxes.check_refusals({{{"--clearance", "-1"}, "clearance of at least 0, found -1"},
                        {{"--clearance", "nan"}, "clearance of at least 0, found nan"},
                        {{"--along", "0,0,0"}, "expected a direction of finite length"},
                        {{"--along", "1,2"}, "--along"},
                        {{"--along", "nan,0,0"}, "expected a direction of finite length"}});
  boxes.words = {"clash", "--poses", "poses.txt"};
  boxes.check_refusals({{{"cube.obj", "none.obj"}, "none.obj"},
                        {{"plane.obj", "plane.obj"}, "expected 3D bodies, found 2D bodies"}});
}

}  // namespace
}  // namespace lrb::test
