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

}  // namespace
}  // namespace lrb::test
