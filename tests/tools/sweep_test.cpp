// lrbscope sweep: what it prints, and what it refuses.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/json_lines.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::test {
namespace {

using Json = nlohmann::json;

struct MovingBoxes {
  Folder folder;
  MovingBoxes() {
    folder.write("cube.obj", kCube);
    write_mesh(shapes::box({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}), folder / "small.obj");
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
  std::vector<std::string> arguments(std::vector<std::string> more) const {
    std::vector<std::string> args = {"--quiet", "sweep", "cube.obj", "small.obj", "--motions", "motions.txt"};
    args.insert(args.end(), more.begin(), more.end());
    return args;
  }
  std::vector<Json> lines(std::vector<std::string> more = {}) const {
    std::vector<Json> out = lines_of(folder, arguments(std::move(more)));
    REQUIRE(out.size() == 6);
    return out;
  }
};

TEST_CASE("sweep: contact, none, from inside, at the start, turning, grazing") {
  const auto lines = MovingBoxes().lines();
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

TEST_CASE("sweep: what cannot be asked is refused in one line") {
  const MovingBoxes boxes;
  for (const char* tolerance : {"0", "-1", "2", "nan"})
    check_refused(boxes.folder, boxes.arguments({"--tolerance", tolerance}));
  check_refused(boxes.folder, boxes.arguments({"--budget", "0"}));
  check_refused(boxes.folder, {"sweep", "cube.obj", "none.obj", "--motions", "motions.txt"});
  const std::string good = "1 0 0 3 0 1 0 0 0 0 1 0  1 0 0 0 0 1 0 0 0 0 1 0\n";
  const auto refused = [&](const std::string& text, const char* said) {
    boxes.folder.write("bad.txt", text);
    const std::string err =
        check_refused(boxes.folder, {"sweep", "cube.obj", "small.obj", "--motions", "bad.txt"}).err;
    CAPTURE(err);
    CHECK(err.find(said) != std::string::npos);
  };
  refused(good + "1 0 0 3 0 1 0 0 0 0 1 0\n", "bad.txt:2: expected 24 numbers");
  refused("# none\n", "bad.txt: no motions");
  refused(good + "1 0 0 3 0 1 0 0 0 0 1 0  1 0 0 nan 0 1 0 0 0 0 1 0\n", "bad.txt:2: ");
  refused(good + "1 0 0 3 0 1 0 0 0 0 1 0  2 0 0 0 0 2 0 0 0 0 2 0\n", "bad.txt:2: ");
  refused(good + "1 0 0 3 0 1 0 0 0 0 1 0  -1 0 0 0 0 1 0 0 0 0 1 0\n", "bad.txt:2: ");
}

}  // namespace
}  // namespace lrb::test
