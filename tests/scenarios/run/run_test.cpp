#include <algorithm>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/generators.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tests/support/approach.hpp"
#include "tests/support/folder.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace_json.hpp>
#include <lrbscope/validate.hpp>

using namespace lrb;

TEST_CASE("only expectations that are not met are reported") {
  spec::Scenario s = test::approach("ball", 4);
  const record::Recording r = record::record(s, record::kSilent);
  spec::Expectation e;
  e.step = 3;
  e.relation = Relation::crossing;
  e.pairs = r.results[3].pairs.size();
  e.fingerprint = fingerprint(r.results[3].pairs);
  e.max_tests = r.results[3].counters.box_tests + r.results[3].counters.face_tests;
  s.expect = {e};
  CHECK(record::mismatches(s, r).empty());
  s.expect[0].max_tests = *e.max_tests - 1;
  REQUIRE(record::mismatches(s, r).size() == 1);
  CHECK(record::mismatches(s, r)[0].find("expected at most " + std::to_string(*e.max_tests - 1) + " tests") !=
        std::string::npos);
  s.expect[0].pairs = *e.pairs + 1;
  s.expect[0].relation = Relation::touching;
  s.expect[0].fingerprint = *e.fingerprint + 1;
  CHECK(record::mismatches(s, r).size() == 4);
  s.expect[0].step = 99;
  CHECK(record::mismatches(s, r).size() == 1);
}

TEST_CASE("moments: first and last are always included, within the limit") {
  const record::Recording r = record::record(test::approach("ball", 4), record::kSilent);
  pictures::FrameSpec spec;
  CHECK(record::moments(spec, r.trace).size() == 8);
  spec.most = 3;
  const std::vector<trace::EventId> three = record::moments(spec, r.trace);
  REQUIRE(three.size() == 3);
  CHECK(three.front() == record::last_event(r.trace, 0));
  CHECK(three.back() == r.trace.events.size() - 1);
  spec.at = pictures::FrameSpec::At::none;
  CHECK(record::moments(spec, r.trace).empty());
  spec.at = pictures::FrameSpec::At::refinement;
  spec.most = 100'000;
  for (const trace::EventId e : record::moments(spec, r.trace))
    CHECK((r.trace.events[e].kind == EventKind::refine || r.trace.events[e].kind == EventKind::step));
  CHECK(pictures::evenly(10, 4) == std::vector<std::size_t>{0, 3, 6, 9});
  CHECK(pictures::evenly(2, 9) == std::vector<std::size_t>{0, 1});
}

TEST_CASE("volumes of known convex hulls") {
  std::vector<Eigen::Vector3d> cube;
  for (int i = 0; i < 27; ++i)
    cube.emplace_back(i % 3, i / 3 % 3, i / 9);  // with points on faces, edges and inside
  CHECK(bodies::hull_volume(cube) == doctest::Approx(8));
  CHECK(bodies::hull_volume(std::vector<Eigen::Vector3d>(cube.begin(), cube.begin() + 9)) == 0);  // flat
  CHECK(bodies::hull_volume({}) == 0);
  const Mesh ball = generators::generate("ball", {{"frequency", 6}});
  const LrbRep rep = LrbRep::without_regions(ball, true, false);
  std::vector<FaceId> faces(rep.real_face_count());
  for (FaceId f = 0; f < faces.size(); ++f) faces[f] = f;
  CHECK(bodies::hull_volume(ball.vertices) ==
        doctest::Approx(enclosed_volume(rep, faces)));  // a convex body is its own hull
  std::vector<Eigen::Vector3d> square = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 2, 0}, {1, 0, 0}};
  CHECK(bodies::hull_area(square) == doctest::Approx(4));
}

TEST_CASE("the shipped collisions meet their expectations") {
  for (const std::string& name : spec::shipped_names(spec::kScenarioEnding)) {
    const spec::Scenario s = spec::open_scenario(name);
    if (s.show != spec::Show::collision) continue;
    CAPTURE(s.name);
    CHECK_FALSE(s.expect.empty());
    const record::Recording r = record::record(s, record::kSilent);
    for (const std::string& line : record::mismatches(s, r)) FAIL_CHECK(line);
  }
}

TEST_CASE("a run whose trace names an invalid vertex is rejected") {
  spec::Scenario s;
  s.bodies.resize(2);
  for (spec::BodySpec& body : s.bodies) body.generator = "ball";
  s.events = EventLevel::nodes;
  s.motion.kind = spec::Motion::Kind::poses;
  s.motion.poses = {Pose::translation({0.1, 0, 5})};
  record::Recording r = record::record(s, record::kSilent);
  const test::Folder folder;
  save_lrb(r.bodies[0].rep, folder / "a.lrb");
  save_lrb(r.bodies[1].rep, folder / "b.lrb");
  const auto write = [&] { trace::save_trace(r.trace, folder / "trace.json"); };
  write();
  CHECK(record::open_run(folder.path.string()).trace == r.trace);
  trace::Event& point = r.trace.events[trace::runs::first_of(r.trace, EventKind::point)];
  point.a = static_cast<std::uint32_t>(r.bodies[static_cast<std::size_t>(point.side)].rep.vertices().size());
  write();
  CHECK_THROWS_AS(record::open_run(folder.path.string()), InputError);
}
