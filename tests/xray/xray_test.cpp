/// Other engines under the same lamp: walks as recordings, and the programs that record them, where these
/// were built.

#include <algorithm>
#include <array>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/workers/workers.hpp"
#include "bench/xray/foreign_walk.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>

namespace lrb::test {
namespace {

std::vector<xray::PosePair> some_poses() {
  return {{{}, Pose::translation({0.9, 0.05, 0.1})},
          {{}, Pose::translation({0.5, 0.1, 0.1})},
          {{}, Pose::translation({5, 0, 0})}};
}

}  // namespace

TEST_CASE("an engine's printed traversal matches its counters, and its pairs are exact in general position") {
  const LrbRep ball = bodies::body_of_mesh(shapes::bumpy_sphere(3, 7, 0.3)).rep,
               ring = bodies::body_of_mesh(shapes::torus(24, 12)).rep;
  int recorded = 0;
  for (const std::string engine : {"fcl", "cgal"}) {
    CAPTURE(engine);
    if (workers::program_beside("lrbscope-xray-" + engine).empty()) {
      MESSAGE("skipped: lrbscope-xray-" << engine << " was not built, for want of its package");
      CHECK_THROWS_AS(xray::walk_of(engine, ball, ring, some_poses()), EnvironmentError);
      continue;
    }
    const capture::Capture walk = xray::walk_of(engine, ball, ring, some_poses());
    REQUIRE(walk.queries.size() == 3);
    for (std::size_t i = 0; i < walk.queries.size(); ++i) {
      const capture::Query& query = walk.queries[i];
      std::array<std::uint64_t, 4> events{};
      std::vector<std::uint64_t> counts;  // the engine's own statistics
      std::vector<SimplexPair> found;
      for (const capture::Event& e : query.events) {
        ++events[static_cast<std::size_t>(e.kind)];
        if (e.kind == capture::EventKind::count) counts.push_back(e.b);
        if (e.kind == capture::EventKind::triangles && e.met > 0)
          found.push_back({SimplexId(e.a), SimplexId(e.b)});
      }
      CHECK(query.complete());
      CHECK(counts == std::vector<std::uint64_t>{events[0], events[1]});
      CHECK(query.pairs == found.size());
      CHECK((query.verdict == capture::Verdict::intersecting) == !found.empty());
      std::sort(found.begin(), found.end());
      const CollideResult exact = collide(ball, some_poses()[i].a, ring, some_poses()[i].b);
      CHECK(found == exact.pairs);
      CHECK((i == 2 || exact.pairs.size() > 20));
    }
    ++recorded;
  }
  MESSAGE("engines recorded: " << recorded);
}

TEST_CASE("xray: a page with both runs, or one error line") {
  const Folder folder;
  write_mesh(shapes::icosphere(2), folder / "ball.obj");
  write_mesh(shapes::circle(12), folder / "circle.obj");
  folder.write("poses.txt", "1 0 0 0.9  0 1 0 0.05  0 0 1 0.1\n");
  folder.write("wide.txt", "2 0 0 0.9  0 2 0 0.05  0 0 2 0.1\n");
  for (const std::string engine : {"fcl", "cgal"}) {
    const std::vector<std::string> words = {"--quiet", "xray", "ball.obj", "ball.obj", "--method",
                                            engine,    "-o",   "out",      "--poses"};
    const auto with = [&](const char* poses) {
      std::vector<std::string> all = words;
      all.emplace_back(poses);
      return run(folder, all);
    };
    if (workers::program_beside("lrbscope-xray-" + engine).empty()) {
      const Outcome rejected = with("poses.txt");
      CHECK(rejected.code != 0);
      CHECK(rejected.error_lines() == 1);
      CHECK(rejected.err.find("lib" + engine + "-dev") != std::string::npos);
      continue;
    }
    const Outcome outcome = with("poses.txt");
    CHECK(outcome.code == 0);
    CHECK(outcome.out == "out/index.html\n");
    CHECK(slurp(folder / "out/index.html").find("Box tests by face, step ") != std::string::npos);
    // The page of an engine without wrappers has no figures of them; lrbscope's own has.
    for (const char* word : {"<td>LRB-rep: regions</td>", "<dt>Without wrapper", ">refinements</th>"}) {
      CAPTURE(word);
      CHECK(slurp(folder / ("out/" + engine + "/index.html")).find(word) == std::string::npos);
    }
    CHECK(slurp(folder / "out/ours/index.html").find("<td>LRB-rep: regions</td>") != std::string::npos);
    CHECK(render::read_png(folder / "out/heat.png").image.width() > 1500);
    const auto theirs = nlohmann::json::parse(slurp(folder / ("out/" + engine + "/summary.json")));
    const auto ours = nlohmann::json::parse(slurp(folder / "out/ours/summary.json"));
    CHECK(theirs["steps"][0]["pairs"] == ours["steps"][0]["pairs"]);
    CHECK(theirs["steps"][0]["counters"]["box_tests"] > 0);
    const Outcome rejected = with("wide.txt");
    CHECK(rejected.code != 0);
    CHECK(rejected.error_lines() == 1);
    CHECK(rejected.err.find("wide.txt:1: pose 0: ") != std::string::npos);
  }
  const Outcome flat =
      run(folder, {"--quiet", "xray", "circle.obj", "circle.obj", "--poses", "poses.txt", "-o", "flat"});
  CHECK(flat.code != 0);
  CHECK(flat.error_lines() == 1);
  CHECK(flat.err.find("circle.obj: expected a 3D body, found a 2D body") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "flat"));
}

}  // namespace lrb::test
