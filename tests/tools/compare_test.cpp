// lrbscope compare: two recorded runs side by side.
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>

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

TEST_CASE("compare: the same run, another recursion, other levels of events, and invalid runs") {
  const Runs runs;
  const Outcome same = run(runs.folder, {"--quiet", "compare", "one", "one", "-o", "same"});
  CHECK(same.code == 0);
  CHECK(same.out == "the runs are identical\nsame/index.html\n");
  const int two = render::read_png(runs.folder / "same/compare.png").image.width();

  const Outcome paper = run(runs.folder, {"--quiet", "compare", "one", "paper", "-o", "out"});
  CHECK(paper.code == 1);  // as diff
  CHECK(paper.out.find("recursion: expected complete, found paper") != std::string::npos);
  CHECK(paper.out.find("step 0, event 1 of the step: ") != std::string::npos);
  CHECK(slurp(runs.folder / "out/index.html").find("<h2>Steps</h2>") != std::string::npos);
  CHECK(render::read_png(runs.folder / "out/compare.png").image.width() > two);  // with the difference

  const Outcome nodes = run(runs.folder, {"--quiet", "compare", "one", "nodes", "-o", "out2"});
  CHECK(nodes.out.find("begin") != std::string::npos);

  const Outcome missing = run(runs.folder, {"--quiet", "compare", "one", ".", "-o", "out3"});
  CHECK(missing.code != 0);
  CHECK(missing.error_lines() == 1);
  CHECK(missing.err.find("trace.json") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(runs.folder / "out3"));
}

TEST_CASE("compare: both runs' views are shown side by side if both pages exist") {
  const Runs runs;
  const auto page = [&](const std::string& folder) { return slurp(runs.folder / (folder + "/index.html")); };
  REQUIRE(run(runs.folder, {"--quiet", "compare", "one", "paper", "-o", "a b/out"}).code == 1);
  const std::string both = page("a b/out");
  CHECK(both.find("<iframe src=\"../../one/index.html?alone\"") != std::string::npos);
  CHECK(both.find("<iframe src=\"../../paper/index.html?alone\"") != std::string::npos);
  CHECK(both.find("frame-src file:") != std::string::npos);
  CHECK(page("one").find("frame-src") == std::string::npos);  // nothing else may be framed
  std::filesystem::rename(runs.folder / "paper", runs.folder / "pa per#");
  REQUIRE(run(runs.folder, {"--quiet", "compare", "one", "pa per#", "-o", "quoted"}).code == 1);
  CHECK(page("quoted").find("<iframe src=\"../pa%20per%23/index.html?alone\"") != std::string::npos);
  std::filesystem::remove(runs.folder / "pa per#/index.html");
  REQUIRE(run(runs.folder, {"--quiet", "compare", "one", "pa per#", "-o", "alone"}).code == 1);
  CHECK(page("alone").find("<iframe") == std::string::npos);
}

TEST_CASE("compare: two constructions of a body, pass by pass; one body with two is rejected") {
  const Runs runs;
  const auto scenario = [](const std::string& build) {
    return "{\"name\": \"built\", \"purpose\": \"Built.\", \"show\": \"construction\", \"bodies\": {\"a\": {\"generator\": "
           "\"rock\", \"parameters\": {\"frequency\": 5}" +
           build + "}}, \"frames\": {\"at\": \"pass\", \"most\": 1}}";
  };
  runs.folder.write("few.json", scenario(", \"build\": {\"patch_interior\": 8}"));
  runs.folder.write("many.json", scenario(", \"build\": {\"patch_interior\": 40}"));
  for (const std::string name : {"few", "many"})
    REQUIRE(run(runs.folder, {"--quiet", "run", name + ".json", "-o", name}).code == 0);
  const Outcome differ = run(runs.folder, {"--quiet", "compare", "few", "many", "-o", "built"});
  CHECK(differ.code == 1);
  CHECK(differ.out.find("step 0, event ") != std::string::npos);
  for (const char* part : {"\nregions: ", " in few, ", " are in both (", " only in many"})
    CHECK(differ.out.find(part) != std::string::npos);
  const std::string page = slurp(runs.folder / "built/index.html");
  for (const char* part : {"<h2>Passes</h2>", "regions, few", "The front by event", "outermost wrapper",
                           "<h2>Regions that differ</h2>", "<tr data-to=\"regions "})
    CHECK(page.find(part) != std::string::npos);
  CHECK(render::read_png(runs.folder / "built/compare.png").image.width() > 900);
  const Outcome same = run(runs.folder, {"--quiet", "compare", "few", "few", "-o", "same"});
  CHECK(same.out.find("the runs are identical") != std::string::npos);
  const Outcome mixed = run(runs.folder, {"--quiet", "compare", "one", "few", "-o", "mixed"});
  CHECK(mixed.code == 2);
  CHECK(mixed.error_lines() == 1);
  CHECK(mixed.err.find("few: is a run of one body, and one of two") != std::string::npos);
}

}  // namespace
}  // namespace lrb::test
