// lrbscope sweep: output and errors.
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"

namespace lrb::test {
namespace {

using Json = nlohmann::json;

struct MovingBoxes : Command {
  MovingBoxes() : Command({"--quiet", "sweep", "cube.obj", "small.obj", "--motions", "motions.txt"}) {
    // From 2.75 to -1.25 along x, into the face x = 1 after 2 of 4; past it; out of it, from inside; from
    // contact on; turning by a quarter meanwhile; as near its upper face as rounding.
    folder.write(
        "motions.txt",
        "# B's poses at t = 0 and t = 1\n"
        "1 0 0 2.75  0 1 0 0  0 0 1 0   1 0 0 -1.25  0 1 0 0  0 0 1 0\n"
        "1 0 0 2.75  0 1 0 3  0 0 1 0   1 0 0 -1.25  0 1 0 3  0 0 1 0\n"
        "1 0 0 0     0 1 0 0  0 0 1 0   1 0 0 4      0 1 0 0  0 0 1 0\n"
        "1 0 0 0.75  0 1 0 0  0 0 1 0   1 0 0 4      0 1 0 0  0 0 1 0\n"
        "1 0 0 2 0 1 0 0 0 0 1 0  0 -1 0 0 1 0 0 0 0 0 1 0\n"
        "1 0 0 2.75  0 1 0 0  0 0 1 0.7500000000000002   1 0 0 -1.25  0 1 0 0  0 0 1 0.7500000000000002\n");
  }
};

TEST_CASE("sweep: contact, no contact, from inside, at the start, rotating, tangential") {
  const auto lines = MovingBoxes().lines();
  REQUIRE(lines.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) CHECK(lines[i]["motion"] == i);
  CHECK(lines[0]["contact"] == true);
  CHECK(lines[0]["t0"].get<double>() <= 0.5);
  CHECK(lines[0]["t1"].get<double>() >= 0.5);
  CHECK(lines[0]["t1"].get<double>() - lines[0]["t0"].get<double>() <= 1e-9);
  CHECK(lines[0]["pair"].size() == 2);
  CHECK(lines[0]["normal"] == Json({1.0, 0.0, 0.0}));
  CHECK(lines[0]["speed"].get<double>() == doctest::Approx(4));
  CHECK(lines[1] == Json({{"motion", 1}, {"contact", false}}));
  CHECK(lines[2]["inside"] == "b_inside_a");
  CHECK(lines[2]["t0"].get<double>() <= 0.125);
  CHECK(lines[2]["t1"].get<double>() >= 0.125);
  CHECK(lines[3]["start"] == true);
  CHECK(lines[3]["t1"] == 0);
  CHECK(!lines[3].contains("normal"));
  CHECK(lines[4]["contact"] == true);
  CHECK(lines[4]["t0"].get<double>() > 0.1);
  CHECK(lines[5]["contact"].is_null());
  CHECK(lines[5]["grazing"] == true);
  CHECK(lines[5]["t0"].get<double>() == doctest::Approx(0.5));
  CHECK(lines[5]["t1"].get<double>() == doctest::Approx(0.8125).epsilon(0.01));
}

TEST_CASE("sweep: tolerance, budget, features, history and times") {
  const MovingBoxes boxes;
  const auto wide = boxes.lines({"--tolerance", "0.01"});
  CHECK(wide[0]["t1"].get<double>() - wide[0]["t0"].get<double>() <= 0.01);
  const auto few = boxes.lines({"--budget", "1"});
  CHECK(few[0]["contact"].is_null());
  CHECK(few[0]["finished"] == false);
  CHECK(few[0]["t0"].get<double>() <= 0.5);
  CHECK(few[0]["t1"] == 1);
  const auto more = boxes.lines({"--features", "--history", "--repeat", "3"});
  CHECK(more[0]["on_a"]["vertices"].size() <= 3);
  CHECK(more[0]["on_b"]["point"].size() == 3);
  CHECK(more[0]["history"].size() > 0);
  CHECK(more[0]["us"].get<double>() > 0);
  CHECK(!more[1].contains("on_a"));
}

TEST_CASE("sweep: invalid requests are rejected in one line") {
  MovingBoxes boxes;
  for (const char* tolerance : {"0", "-1", "2", "nan"})
    boxes.check_refusals({{{"--tolerance", tolerance}, "first contact: expected a tolerance"}});
  boxes.check_refusals({{{"--budget", "0"}, "--budget"}});
  boxes.words = {"sweep", "cube.obj"};
  boxes.check_refusals({{{"none.obj", "--motions", "motions.txt"}, "none.obj"}});
  const std::string good = "1 0 0 3 0 1 0 0 0 0 1 0  1 0 0 0 0 1 0 0 0 0 1 0\n";
  const std::string start = good + "1 0 0 3 0 1 0 0 0 0 1 0";
  const std::pair<std::string, std::string> bad[] = {{start + "\n", "bad.txt:2: expected 24 numbers"},
                                                     {"# none\n", "bad.txt: no motions"},
                                                     {start + "  1 0 0 nan 0 1 0 0 0 0 1 0\n", "bad.txt:2: "},
                                                     {start + "  2 0 0 0 0 2 0 0 0 0 2 0\n", "bad.txt:2: "},
                                                     {start + "  -1 0 0 0 0 1 0 0 0 0 1 0\n", "bad.txt:2: "}};
  for (const auto& [text, says] : bad) {
    boxes.folder.write("bad.txt", text);
    boxes.check_refusals({{{"small.obj", "--motions", "bad.txt"}, says}});
  }
}

}  // namespace
}  // namespace lrb::test
