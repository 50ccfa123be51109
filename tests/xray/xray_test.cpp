/// Other engines under the same lamp: walks as recordings, and the programs that record them, where these
/// were built.

#include <algorithm>

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
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/trace_json.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::test {
namespace {

using xray::ForeignEvent;

/// A tree of a root, two nodes, and a leaf each for the four triangles of a tetrahedron.
trace::TreeShape four_leaves() {
  trace::TreeShape tree;
  const trace::ShapeBox box{Eigen::Vector3d::Zero(),
                            {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}};
  tree.add(std::array<std::uint32_t, 2>{1, 2}, {}, box);
  tree.add(std::array<std::uint32_t, 2>{3, 4}, {}, box);
  tree.add(std::array<std::uint32_t, 2>{5, 6}, {}, box);
  for (std::uint32_t s = 0; s < 4; ++s) tree.add({}, std::array<SimplexId, 1>{SimplexId(s)}, box);
  tree.finish();
  return tree;
}

run::Recording tetrahedra(spec::Scenario& scenario) {
  scenario.name = "test";
  scenario.motion.poses = {Pose::translation({0.1, 0.1, 0.1})};
  scenario.bodies = {{}, {}};
  scenario.events = EventLevel::nodes;
  std::vector<bodies::LoadedBody> bodies(2, bodies::body_of_mesh(shapes::tetrahedron()));
  return run::record(scenario, std::move(bodies), run::kSilent);
}

std::vector<xray::PosePair> some_poses() {
  return {{{}, Pose::translation({0.9, 0.05, 0.1})},
          {{}, Pose::translation({0.5, 0.1, 0.1})},
          {{}, Pose::translation({5, 0, 0})}};
}

}  // namespace

TEST_CASE("a walk of another engine becomes a trace: which pair led to which, and what met") {
  xray::ForeignWalk walk{"Toy 1.0", {four_leaves(), four_leaves()}, {}};
  // Both roots; A's first node; B's first node; two leaves of these, tested; B's second node, apart.
  walk.steps.push_back({{{false, 0, 0, true},
                         {false, 1, 0, true},
                         {false, 1, 1, true},
                         {false, 3, 1, true},
                         {false, 3, 3, true},
                         {true, 0, 0, true},
                         {false, 3, 4, false},
                         {false, 4, 1, false},
                         {false, 1, 2, false},
                         {false, 2, 0, false}},
                        9,
                        1});
  spec::Scenario scenario;
  const run::Recording ours = tetrahedra(scenario);
  const run::Recording theirs = xray::recording_of(walk, ours, scenario);
  std::vector<std::array<std::uint32_t, 5>> found;  // a, b, parent's a, parent's b, met
  for (const trace::Event& e : theirs.trace.events) {
    if (e.kind != EventKind::node_pair) continue;
    const trace::Event* above = e.cause == kNull ? nullptr : &theirs.trace.events[e.cause];
    found.push_back({e.a, e.b, above ? above->a : 99, above ? above->b : 99, e.work().met});
  }
  CHECK(found == std::vector<std::array<std::uint32_t, 5>>{{0, 0, 99, 99, 2},
                                                           {1, 0, 0, 0, 2},
                                                           {1, 1, 1, 0, 2},
                                                           {3, 1, 1, 1, 2},
                                                           {3, 3, 3, 1, 1},
                                                           {3, 4, 3, 1, 0},
                                                           {4, 1, 1, 1, 0},
                                                           {1, 2, 1, 0, 0},
                                                           {2, 0, 0, 0, 0}});
  const trace::Step& step = theirs.trace.steps.at(0);
  CHECK(step.result.counters.box_tests == 9);
  CHECK(step.result.counters.face_tests == 1);
  CHECK(step.result.pair_count == 1);
  CHECK(theirs.trace.header.engine == "Toy 1.0");
  CHECK(trace::trace_from_json(trace::trace_to_json(theirs.trace), "t.json") == theirs.trace);
  // What it got wrong is told step by step.
  const xray::WrongPairs reported = xray::wrong_pairs(walk.steps[0], ours.results[0].pairs);
  REQUIRE(theirs.wrong.size() == 1);
  REQUIRE(theirs.wrong[0].size() == reported.too_many.size() + reported.missing.size());
  REQUIRE(!reported.missing.empty());  // it looked at one pair of faces alone
  for (std::size_t i = 0; i < theirs.wrong[0].size(); ++i) {
    const run::WrongPair& w = theirs.wrong[0][i];
    const std::size_t many = reported.too_many.size();
    CHECK(w.missed == (i >= many));
    CHECK(w.pair == (w.missed ? reported.missing[i - many] : reported.too_many[i]));
  }
  const trace::NodeCounts counts = trace::count_nodes(theirs.trees[0], Side::a, theirs.trace.events);
  CHECK(counts.visits == std::vector<std::uint32_t>{1, 3, 1, 3, 1, 0, 0});
  const xray::WrongPairs wrong = xray::wrong_pairs(walk.steps[0], {{0, 1}, {2, 2}});
  CHECK((wrong.too_many == std::vector<SimplexPair>{{0, 0}}));
  CHECK((wrong.missing == std::vector<SimplexPair>{{0, 1}, {2, 2}}));
}

TEST_CASE("an engine that tests leaves without a test of their boxes: these are led to, too") {
  xray::ForeignWalk walk{"Toy 1.0", {four_leaves(), four_leaves()}, {}};
  walk.steps.push_back({{{false, 3, 1, true}, {true, 0, 0, false}, {true, 0, 1, true}}, 1, 2});
  spec::Scenario scenario;
  const run::Recording theirs = xray::recording_of(walk, tetrahedra(scenario), scenario);
  const auto pair = std::find_if(theirs.trace.events.begin(), theirs.trace.events.end(),
                                 [](const trace::Event& e) { return e.kind == EventKind::node_pair; });
  REQUIRE(pair != theirs.trace.events.end());
  CHECK(pair->work().met == 2);
  CHECK(pair->node_end().step == NodeStep::descend_b);
}

TEST_CASE(
    "what an engine's program prints is what it counts, and its pairs are the exact ones in general position") {
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
    const xray::ForeignWalk walk = xray::walk_of(engine, ball, ring, some_poses());
    REQUIRE(walk.steps.size() == 3);
    for (std::size_t i = 0; i < walk.steps.size(); ++i) {
      const xray::ForeignStep& step = walk.steps[i];
      const auto leaf_tests = static_cast<std::uint64_t>(std::count_if(
          step.events.begin(), step.events.end(), [](const ForeignEvent& e) { return e.is_leaf_test; }));
      CHECK(step.leaf_tests == leaf_tests);  // FCL's own statistics
      CHECK(step.box_tests == step.events.size() - leaf_tests);
      const CollideResult exact = collide(ball, some_poses()[i].a, ring, some_poses()[i].b);
      const xray::WrongPairs wrong = xray::wrong_pairs(step, exact.pairs);
      CHECK(wrong.too_many.empty());
      CHECK(wrong.missing.empty());
      CHECK((i == 2 || exact.pairs.size() > 20));
    }
    ++recorded;
  }
  MESSAGE("engines recorded: " << recorded);
}

TEST_CASE("xray: a page with both runs, or one clear error") {
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
