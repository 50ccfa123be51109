// lrbscope distance: output and errors.
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"

namespace lrb::test {
namespace {

using Json = nlohmann::json;

struct Boxes : Command {
  Boxes() : Command({"--quiet", "distance", "cube.obj", "small.obj", "--poses", "poses.txt"}) {
    // 2 away along x; held; touching; past a corner by 3 and 4 in y and z
    folder.write("poses.txt",
                 "1 0 0 2.75  0 1 0 0  0 0 1 0\n1 0 0 0  0 1 0 0  0 0 1 0\n"
                 "1 0 0 0.75  0 1 0 0  0 0 1 0\n1 0 0 0  0 1 0 3.75  0 0 1 4.75\n");
  }
};

TEST_CASE("without --poses, B stays in place, in every command that takes poses") {
  Command c({"--quiet"});
  c.folder.write("in_place.txt", "1 0 0 0  0 1 0 0  0 0 1 0\n");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"query", "cube.obj", "small.obj", "--pairs", "--distance"},
        {"distance", "cube.obj", "small.obj"},
        {"clash", "cube.obj", "small.obj"},
        {"near", "cube.obj", "small.obj", "--within", "0.3"},
        {"manifold", "cube.obj", "small.obj", "--margin", "0.3"}}) {
    CAPTURE(command[0]);
    const auto in_place = c.lines(command);
    REQUIRE(in_place.size() == 1);
    std::vector<std::string> posed = command;
    posed.insert(posed.end(), {"--poses", "in_place.txt"});
    CHECK(c.lines(posed) == in_place);
  }
}

TEST_CASE("distance: intervals, points, and solids") {
  const auto lines = Boxes().lines();
  REQUIRE(lines.size() == 4);
  const double expected[] = {2, 0.25, 0, 5};
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(i);
    const Json& line = lines[i];
    CHECK(line["pose"] == i);
    CHECK(line["lower"].get<double>() <= expected[i]);
    CHECK(line["upper"].get<double>() >= expected[i]);
    CHECK(line["upper"].get<double>() - line["lower"].get<double>() < 1e-11);
    double square = 0;
    for (std::size_t x = 0; x < 3; ++x)
      square += std::pow(line["point_a"][x].get<double>() - line["point_b"][x].get<double>(), 2);
    CHECK(std::sqrt(square) == doctest::Approx(expected[i]).epsilon(1e-12));
    CHECK(line.contains("solids") == (i == 1));
    CHECK(!line.contains("within"));
    CHECK(!line.contains("us"));
  }
  CHECK(lines[1]["solids"] == 0);
  CHECK(lines[2]["upper"] == 0);
  CHECK(lines[3]["point_a"][1] == 1);
  CHECK(lines[3]["point_a"][2] == 1);
}

TEST_CASE("distance: within, tolerance, budget, features and times") {
  const Boxes boxes;
  const auto within = boxes.lines({"--within", "2"});
  CHECK(within[0]["within"] == true);
  CHECK(within[1]["within"] == true);
  CHECK(within[2]["within"] == true);
  CHECK(within[3]["within"] == false);
  CHECK(boxes.lines({"--within", "1.9999999999999998"})[0]["within"] == false);
  const auto wide = boxes.lines({"--tolerance", "1"});
  CHECK(wide[0]["upper"].get<double>() - wide[0]["lower"].get<double>() <= 1);
  const auto few = boxes.lines({"--budget", "1"});
  CHECK(few[0].contains("finished"));
  CHECK(few[0]["lower"].get<double>() <= 2);
  CHECK(few[0]["upper"].get<double>() >= 2);
  const auto features = boxes.lines({"--features", "--repeat", "3"});
  CHECK(features[3]["on_a"]["vertices"].size() <= 3);
  CHECK(features[3]["on_a"]["face"].get<int>() < 6);
  CHECK(features[3]["us"].get<double>() > 0);
}

TEST_CASE("distance: invalid requests are rejected in one line") {
  Boxes boxes;
  boxes.check_refusals({{{"--within", "-1"}, "`within` of at least 0, found -1"},
                        {{"--within", "nan"}, "`within` of at least 0, found nan"},
                        {{"--tolerance", "-1e-9"}, "`tolerance`"},
                        {{"--budget", "0"}, "--budget"}});
  boxes.words = {"distance", "cube.obj"};
  boxes.folder.write("bad.txt", "1 0 0\n");
  boxes.folder.write("far.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1e308 1e308 1e308 1e308 0 1 0 0 0 0 1 0\n");
  boxes.check_refusals({{{"none.obj", "--poses", "poses.txt"}, "none.obj"},
                        {{"small.obj", "--poses", "bad.txt"}, "bad.txt:1"},
                        {{"small.obj", "--poses", "far.txt"}, "far.txt:2"}});
}

}  // namespace
}  // namespace lrb::test
