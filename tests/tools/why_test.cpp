// lrbscope why: output that agrees with `query`, and errors before anything is written.
#include <string>

#include <doctest/doctest.h>

#include "tests/support/command.hpp"
#include "tests/support/pixels.hpp"

namespace lrb::test {
namespace {

struct Bodies : Command {
  Bodies() : Command({"--quiet", "why", "ball.obj", "ring.obj", "--poses", "poses.txt"}) {
    write_mesh(shapes::icosphere(2), folder / "ball.obj");
    write_mesh(shapes::torus(16, 8), folder / "ring.obj");
    folder.write("poses.txt", "1 0 0 0.9  0 1 0 0  0 0 1 0.1\n1 0 0 9  0 1 0 0  0 0 1 0\n");
  }
};

TEST_CASE("why: a pair of the answer, as JSON, as text and as a picture") {
  const Bodies bodies;
  const auto query =
      run(bodies.folder, {"--quiet", "query", "ball.obj", "ring.obj", "--poses", "poses.txt", "--pairs"});
  const auto list = nlohmann::json::parse(query.out.substr(0, query.out.find('\n')))["list"];
  REQUIRE(!list.empty());
  const std::string pair =
      std::to_string(list[0][0].get<int>()) + "," + std::to_string(list[0][1].get<int>());
  const Outcome json = bodies.run({"--pair", pair, "--json", "-o", "pictures/pair.png"});
  CHECK(json.code == 0);
  const auto j = nlohmann::json::parse(json.out);
  CHECK(j["pair"] == list[0]);
  CHECK(j["meet"] != "disjoint");
  CHECK(j["nodes"][0]["a"] == 0);
  CHECK(j["contact"]["points"].size() > 0);
  CHECK(render::read_png(bodies.folder / "pictures/pair.png").image.width() == 1200);
  const Outcome text = bodies.run({"--pair", pair});
  CHECK(text.out.find("decided by") != std::string::npos);
  CHECK(text.out.find("contact: segment") != std::string::npos);
}

TEST_CASE("why: separate bodies") {
  const Bodies bodies;
  const Outcome text = bodies.run({"--pose", "1"});
  CHECK(text.code == 0);
  CHECK(text.out.rfind("separate, 0 pairs\nboxes of the bodies: gap >= ", 0) == 0);
  CHECK(text.out.find("also prove it") != std::string::npos);
  const auto j = nlohmann::json::parse(bodies.run({"--pose", "1", "--json"}).out);
  CHECK(j["roots"]["gap"] > 5);
  CHECK(j["separation"]["refined"] == nlohmann::json({0, 0}));
  const auto pair =
      nlohmann::json::parse(bodies.run({"--pose", "1", "--pair", "0,0", "--json", "-o", "apart.png"}).out);
  CHECK(pair["meet"] == "disjoint");
  CHECK(pair["decided_by"] == "node_boxes");
  CHECK(pair["distance"] > 5);
  const std::string far = bodies.run({"--pose", "1", "--pair", "0,0"}).out;
  CHECK(far.find("\ndistance ") != std::string::npos);
  CHECK(far.find("units in the last place") == std::string::npos);
  CHECK(render::read_png(bodies.folder / "apart.png").image.width() == 1200);
}

TEST_CASE(
    "why: faces that nearly touch, in units in the last place; a contact too short to print is a point") {
  const Folder folder;
  const std::string foot = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";
  const auto text = [&](const std::string& z) {
    folder.write("foot.obj", foot);
    // Its edge from vertex 1 to 2 is 1e-9 long in the plane of the foot's first face.
    folder.write("tip.obj", "v 0.25 0.25 " + z + "\nv 0.2500000001 0.25 " + z +
                                "\nv 0.25 0.3 1\nv 0.2 0.2 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    return run(folder, {"-q", "why", "foot.obj", "tip.obj", "--pair", "0,0"}).out;
  };
  const std::string touching = text("0");
  CAPTURE(touching);
  CHECK(touching.find("contact: point (0.25, 0.25, 0)\n") != std::string::npos);
  CHECK(text("1e-15").find("units in the last place") != std::string::npos);
}

TEST_CASE("why: a separating plane of separate bodies") {
  const Bodies bodies;
  CHECK(bodies.run({"--pose", "1", "-o", "plane.png"}).out.find("separating plane with normal (") !=
        std::string::npos);
  const auto j = nlohmann::json::parse(bodies.run({"--pose", "1", "--json"}).out);
  CHECK(j["plane"]["gap"] > 5);
  // Beside the whole is a close-up that looks along the plane: a line in the middle of the gap.
  const render::Image picture = render::read_png(bodies.folder / "plane.png").image;
  const auto greens = [&](double from, double to) {
    return count_pixels(picture, {from, 0, to, 1},
                        [](render::Rgba c) { return c.g > c.r + 40 && c.g > c.b + 20; });
  };
  CHECK(greens(0.725, 0.775) > 100);
  CHECK(greens(0.5, 0.725) + greens(0.775, 1) == 0);
  CHECK(j["plane"]["normal"][0] == doctest::Approx(1));
}

TEST_CASE("why: a step of a run, by the run's folder or its trace") {
  Bodies bodies;
  REQUIRE(run(bodies.folder, {"--quiet", "collide", "ball.obj", "ring.obj", "--poses", "poses.txt", "-o",
                              "out", "--most", "1"})
              .code == 0);
  const auto why = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"--quiet", "why"});
    return run(bodies.folder, more);
  };
  for (const char* place : {"out", "out/trace.json"}) {
    CHECK(why({"--run", place, "--step", "0", "--pair", "3,4", "--json"}).out ==
          bodies.run({"--pair", "3,4", "--json"}).out);
    CHECK(why({"--run", place, "--json"}).out == bodies.run({"--pose", "1", "--json"}).out);  // the last step
  }
  bodies.words = {"--quiet", "why"};
  bodies.check_refusals(
      {{{"--run", "out", "--step", "2"}, "no step 2 in the trace; expected one from 0 to 1"},
       {{"--run", "nowhere"}, "nowhere"},
       {{"--run", "out", "ball.obj", "ring.obj"}, "--run"},
       {{"--step", "1"}, "--run"},
       {{"ball.obj"}, "expected two bodies A and B, or --run"}});
  std::filesystem::copy_file(bodies.folder / "out/b.lrb", bodies.folder / "out/a.lrb",
                             std::filesystem::copy_options::overwrite_existing);
  bodies.check_refusals({{{"--run", "out"}, "the .lrb file next to it is not the recorded body A"}});
}

TEST_CASE("why: invalid input is rejected in one line, and nothing is written") {
  Bodies bodies;
  bodies.words = bodies.with({"-o", "no.png"});
  bodies.check_refusals({{{"--pair", "0,99999"}, "simplex of B: expected a number below "},
                         {{"--pair", "0,0", "--pose", "2"}, "expected a pose number below 2, found 2"},
                         {{}, "-o: the bodies intersect"},
                         {{"--pair", "0"}, "--pair"},
                         {{"--pair", "-1,0"}, "--pair"}});
}

}  // namespace
}  // namespace lrb::test
