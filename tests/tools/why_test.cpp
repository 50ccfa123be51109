// lrbscope why: what it prints agrees with `query`, and bad input is refused before anything is written.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>

namespace lrb::test {
namespace {

struct Bodies {
  Folder folder;
  Bodies() {
    write_mesh(shapes::icosphere(2), folder / "ball.obj");
    write_mesh(shapes::torus(16, 8), folder / "ring.obj");
    folder.write("poses.txt", "1 0 0 0.9  0 1 0 0  0 0 1 0.1\n1 0 0 9  0 1 0 0  0 0 1 0\n");
  }
  Outcome why(std::vector<std::string> more) const {
    std::vector<std::string> args = {"--quiet", "why", "ball.obj", "ring.obj", "--poses", "poses.txt"};
    args.insert(args.end(), more.begin(), more.end());
    return run(folder, args);
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
  const Outcome json = bodies.why({"--pair", pair, "--json", "-o", "pictures/pair.png"});
  CHECK(json.code == 0);
  const auto j = nlohmann::json::parse(json.out);
  CHECK(j["pair"] == list[0]);
  CHECK(j["meet"] != "disjoint");
  CHECK(j["nodes"][0]["a"] == 0);
  CHECK(j["contact"]["points"].size() > 0);
  CHECK(render::read_png(bodies.folder / "pictures/pair.png").image.width() == 1200);
  const Outcome text = bodies.why({"--pair", pair});
  CHECK(text.out.find("decided by") != std::string::npos);
  CHECK(text.out.find("contact: segment") != std::string::npos);
}

TEST_CASE("why: bodies that are apart") {
  const Bodies bodies;
  const Outcome text = bodies.why({"--pose", "1"});
  CHECK(text.code == 0);
  CHECK(text.out.rfind("separate, 0 pairs\nboxes round the bodies: gap >= ", 0) == 0);
  CHECK(text.out.find("prove it too") != std::string::npos);
  const auto j = nlohmann::json::parse(bodies.why({"--pose", "1", "--json"}).out);
  CHECK(j["roots"]["gap"] > 5);
  CHECK(j["separation"]["refined"] == nlohmann::json({0, 0}));
  const auto pair =
      nlohmann::json::parse(bodies.why({"--pose", "1", "--pair", "0,0", "--json", "-o", "apart.png"}).out);
  CHECK(pair["meet"] == "disjoint");
  CHECK(pair["decided_by"] == "node_boxes");
  CHECK(pair["distance"] > 5);
  const std::string far = bodies.why({"--pose", "1", "--pair", "0,0"}).out;
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

TEST_CASE("why: what parts bodies that are apart") {
  const Bodies bodies;
  CHECK(bodies.why({"--pose", "1", "-o", "plane.png"})
            .out.find("has all of A on one side and all of B on the other, gap >= ") != std::string::npos);
  const auto j = nlohmann::json::parse(bodies.why({"--pose", "1", "--json"}).out);
  CHECK(j["plane"]["gap"] > 5);
  // Beside the whole is a close-up that looks along the plane: a line in the middle of the gap.
  const render::Image picture = render::read_png(bodies.folder / "plane.png").image;
  const auto greens = [&](int from, int to) {
    int n = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = from; x < to; ++x) {
        const render::Rgba& c = picture.at(x, y);
        n += c.g > c.r + 40 && c.g > c.b + 20;
      }
    return n;
  };
  const int half = picture.width() / 2, middle = half * 3 / 2, room = half / 20;
  CHECK(greens(middle - room, middle + room) > 100);
  CHECK(greens(half, middle - room) + greens(middle + room, picture.width()) == 0);
  CHECK(j["plane"]["normal"][0] == doctest::Approx(1));
}

TEST_CASE("why: a step of a run, by the run's folder or its trace") {
  const Bodies bodies;
  REQUIRE(run(bodies.folder, {"--quiet", "collide", "ball.obj", "ring.obj", "--poses", "poses.txt", "-o",
                              "out", "--most", "1"})
              .code == 0);
  const auto why = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"--quiet", "why"});
    return run(bodies.folder, more);
  };
  for (const char* place : {"out", "out/trace.json"}) {
    CHECK(why({"--run", place, "--step", "0", "--pair", "3,4", "--json"}).out ==
          bodies.why({"--pair", "3,4", "--json"}).out);
    CHECK(why({"--run", place, "--json"}).out == bodies.why({"--pose", "1", "--json"}).out);  // the last step
  }
  const auto refused = [&](const std::vector<std::string>& more, const std::string& what) {
    const Outcome o = why(more);
    CHECK(o.code == 2);
    CHECK(o.error_lines() == 1);
    CAPTURE(o.err);
    CHECK(o.err.find(what) != std::string::npos);
  };
  refused({"--run", "out", "--step", "2"}, "has no step 2; its steps go from 0 to 1");
  refused({"--run", "nowhere"}, "nowhere");
  refused({"--run", "out", "ball.obj", "ring.obj"}, "--run");
  refused({"--step", "1"}, "--run");
  refused({"ball.obj"}, "expected two bodies, A and B, or --run");
  std::filesystem::copy_file(bodies.folder / "out/b.lrb", bodies.folder / "out/a.lrb",
                             std::filesystem::copy_options::overwrite_existing);
  refused({"--run", "out"}, "the body beside it is not the one that was recorded as A");
}

TEST_CASE("why: bad input is refused in one line, and nothing is written") {
  const Bodies bodies;
  const auto refused = [&](std::vector<std::string> more, const std::string& what) {
    more.insert(more.end(), {"-o", "no.png"});
    const Outcome o = bodies.why(more);
    CHECK(o.code == 2);
    CHECK(o.err.find(what) != std::string::npos);
    CHECK(o.out.empty());
    CHECK_FALSE(std::filesystem::exists(bodies.folder.path / "no.png"));
  };
  refused({"--pair", "0,99999"}, "no simplex 99999 of B: there are ");
  refused({"--pair", "0,0", "--pose", "2"}, "has 2 poses, numbered from 0; there is no pose 2");
  refused({}, "-o: the bodies meet");
  refused({"--pair", "0"}, "--pair");
  refused({"--pair", "-1,0"}, "--pair");
}

}  // namespace
}  // namespace lrb::test
