// lrbscope compare: two recorded runs side by side.
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "engine/mesh/io/mesh_io.hpp"
#include "render/png.hpp"
#include "scenarios/bodies/shapes/shapes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/program.hpp"

namespace lrb::test {
namespace {

struct Runs {
  Folder folder;
  Runs() {
    write_mesh(shapes::icosphere(2), folder / "ball.obj");
    write_mesh(shapes::torus(16, 8), folder / "ring.obj");
    folder.write("poses.txt", "1 0 0 0.9  0 1 0 0  0 0 1 0.1\n1 0 0 0.4  0 1 0 0  0 0 1 0\n");
    record("one", {});
    record("nodes", {"--events", "nodes"});
    record("paper", {"--recursion", "paper"});
  }
  void record(const std::string& name, std::vector<std::string> more) const {
    std::vector<std::string> args = {"--quiet",   "collide", "ball.obj", "ring.obj", "--poses",
                                     "poses.txt", "--most",  "1",        "-o",       name};
    args.insert(args.end(), more.begin(), more.end());
    REQUIRE(run(folder, args).code == 0);
  }
};

TEST_CASE("compare: the same run, another recursion, other levels of events; and what is no run") {
  const Runs runs;
  const Outcome same = run(runs.folder, {"--quiet", "compare", "one", "one", "-o", "same"});
  CHECK(same.code == 0);
  CHECK(same.out == "the runs are the same\nsame/index.html\n");
  const int two = render::read_png(runs.folder / "same/compare.png").image.width();

  const Outcome paper = run(runs.folder, {"--quiet", "compare", "one", "paper", "-o", "out"});
  CHECK(paper.code == 0);
  CHECK(paper.out.find("recursion: expected complete, found paper") != std::string::npos);
  CHECK(paper.out.find("step 0, event 1 of the step: ") != std::string::npos);
  CHECK(slurp(runs.folder / "out/index.html").find("Step by step") != std::string::npos);
  CHECK(render::read_png(runs.folder / "out/compare.png").image.width() > two);  // with the difference

  const Outcome nodes = run(runs.folder, {"--quiet", "compare", "one", "nodes", "-o", "out2"});
  CHECK(nodes.out.find("begin") != std::string::npos);

  const Outcome missing = run(runs.folder, {"--quiet", "compare", "one", ".", "-o", "out3"});
  CHECK(missing.code != 0);
  CHECK(missing.error_lines() == 1);
  CHECK(missing.err.find("trace.json") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(runs.folder / "out3"));
}

TEST_CASE("compare: both runs' views stand side by side as long as both pages are there") {
  const Runs runs;
  const auto page = [&](const std::string& folder) { return slurp(runs.folder / (folder + "/index.html")); };
  REQUIRE(run(runs.folder, {"--quiet", "compare", "one", "paper", "-o", "a b/out"}).code == 0);
  const std::string both = page("a b/out");
  CHECK(both.find("<iframe src=\"../../one/index.html?alone\"") != std::string::npos);
  CHECK(both.find("<iframe src=\"../../paper/index.html?alone\"") != std::string::npos);
  CHECK(both.find("frame-src file:") != std::string::npos);
  CHECK(page("one").find("frame-src") == std::string::npos);  // nothing else may be framed
  std::filesystem::rename(runs.folder / "paper", runs.folder / "pa per#");
  REQUIRE(run(runs.folder, {"--quiet", "compare", "one", "pa per#", "-o", "quoted"}).code == 0);
  CHECK(page("quoted").find("<iframe src=\"../pa%20per%23/index.html?alone\"") != std::string::npos);
  std::filesystem::remove(runs.folder / "pa per#/index.html");
  REQUIRE(run(runs.folder, {"--quiet", "compare", "one", "pa per#", "-o", "alone"}).code == 0);
  CHECK(page("alone").find("<iframe") == std::string::npos);
}

}  // namespace
}  // namespace lrb::test
