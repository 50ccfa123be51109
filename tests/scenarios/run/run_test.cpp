#include <algorithm>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "render/pictures/panel.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/validate.hpp>

using namespace lrb;

namespace {

spec::Scenario two_balls() {
  spec::Scenario s;
  s.name = "two_balls";
  s.bodies.resize(2);
  for (spec::BodySpec& body : s.bodies) {
    body.generator = "ball";
    body.parameters = {{"frequency", 4}};
  }
  s.motion.kind = spec::Motion::Kind::approach;
  s.motion.from = {3, 0.2, 0.1};
  s.motion.steps = 1000;
  s.motion.before = 3;
  s.motion.into = 4;
  return s;
}

}  // namespace

TEST_CASE("an approach ends in contact: separate before, in contact from then on") {
  const run::Recording r = run::record(two_balls(), run::kSilent);
  REQUIRE(r.results.size() == 8);
  for (std::size_t step = 0; step < 3; ++step) CHECK(r.results[step].relation == Relation::separate);
  for (std::size_t step = 3; step < 8; ++step) CHECK(r.results[step].relation == Relation::crossing);
  CHECK(r.trace.steps.size() == 8);
}

TEST_CASE("an approach that misses reports it and still shows the path") {
  spec::Scenario s = two_balls();
  s.motion.target = {0, 5, 0};
  const run::Recording r = run::record(s, run::kSilent);
  CHECK(r.results.size() >= 2);
  for (const CollideResult& result : r.results) CHECK(result.relation == Relation::separate);
  REQUIRE(r.notes.size() == 1);
  CHECK(r.notes[0].find("do not touch") != std::string::npos);
}

TEST_CASE("only expectations that are not met are reported") {
  spec::Scenario s = two_balls();
  const run::Recording r = run::record(s, run::kSilent);
  spec::Expectation e;
  e.step = 3;
  e.relation = Relation::crossing;
  e.pairs = r.results[3].pairs.size();
  e.fingerprint = fingerprint(r.results[3].pairs);
  e.max_tests = r.results[3].counters.box_tests + r.results[3].counters.face_tests;
  s.expect = {e};
  CHECK(run::mismatches(s, r).empty());
  s.expect[0].max_tests = *e.max_tests - 1;
  REQUIRE(run::mismatches(s, r).size() == 1);
  CHECK(run::mismatches(s, r)[0].find("expected at most " + std::to_string(*e.max_tests - 1) + " tests") !=
        std::string::npos);
  s.expect[0].pairs = *e.pairs + 1;
  s.expect[0].relation = Relation::touching;
  s.expect[0].fingerprint = *e.fingerprint + 1;
  CHECK(run::mismatches(s, r).size() == 4);
  s.expect[0].step = 99;
  CHECK(run::mismatches(s, r).size() == 1);
}

spec::Scenario one_rock(spec::Show show) {
  spec::Scenario s;
  s.name = "one";
  s.bodies.resize(1);
  s.bodies[0].generator = "rock";
  s.bodies[0].parameters = {{"frequency", 6}};
  s.show = show;
  s.frames = spec::default_frames(show);
  return s;
}

TEST_CASE(
    "refinement goes from the outermost wrapper to the body, construction from the body to the wrapper") {
  const run::Recording down = run::record(one_rock(spec::Show::refinement), run::kSilent);
  const LrbRep& rep = down.bodies[0].rep;
  CHECK(down.trace.events.size() == 1 + rep.region_count());
  CHECK(down.trace.events.back().boundary == rep.real_face_count());

  const spec::Scenario s = one_rock(spec::Show::construction);
  const run::Recording up = run::record(s, run::kSilent);
  CHECK(up.bodies[0].rep.hash() == rep.hash());
  const std::vector<trace::EventId> frames = run::moments(s.frames, up.trace);
  REQUIRE(frames.size() == rep.layer_count() + 1);
  CHECK(frames.front() == 0);
  CHECK(up.trace.events[frames.back()].boundary == rep.outermost_faces().size());
  CHECK(up.trace.events.back().kind == EventKind::closed);
  CHECK_THROWS_AS(run::moments(s.frames, down.trace), InputError);
}

TEST_CASE("a construction's frames show accepted and rejected caps of each pass, and no refinements") {
  const spec::Scenario s = one_rock(spec::Show::construction);
  const run::Recording r = run::record(s, run::kSilent);
  const run::RecordedRun p = run::recorded_run_of(s, r);
  run::FrameState state(p, s.frames, false);
  std::string all;
  std::size_t rejections = 0;
  for (const trace::EventId e : run::moments(s.frames, r.trace)) {
    state.seek(e);
    const render::Overlay overlay = state.overlay(s.name);
    const render::Scene scene = state.scene();
    all += overlay.title + overlay.event + state.caption() + state.short_caption();
    for (const render::OverlayCounter& c : overlay.counters) all += c.name + c.value;
    for (const render::LegendItem& item : scene.key) all += item.text;
    rejections += overlay.event.find("rejected: ") != std::string::npos;
    CHECK((e == 0 || overlay.event.starts_with("pass ")));
    const bool new_lids = std::any_of(scene.key.begin(), scene.key.end(), [](const render::LegendItem& i) {
      return i.text == "new lids, one colour per region";
    });
    CHECK(new_lids == (e != 0));
  }
  CHECK(rejections > 3);
  CHECK(all.find("refine") == std::string::npos);
  state.seek(static_cast<trace::EventId>(r.trace.events.size() - 1));
  CHECK(state.caption().starts_with("Built: "));
}

TEST_CASE("a body loaded with regions is shown layer by layer") {
  spec::Scenario s = one_rock(spec::Show::construction);
  s.bodies[0].generator = "fractal";
  s.bodies[0].parameters = {};
  const run::Recording r = run::record(s, run::kSilent);
  const LrbRep& rep = r.bodies[0].rep;
  CHECK(r.trace.header.construction);
  CHECK(r.notes.size() == 1);
  const std::vector<trace::EventId> frames = run::moments(s.frames, r.trace);
  REQUIRE(frames.size() == rep.layer_count() + 1);
  CHECK(r.trace.events[frames.back()].boundary == rep.outermost_faces().size());
}

TEST_CASE("moments: first and last are always included, within the limit") {
  const run::Recording r = run::record(two_balls(), run::kSilent);
  render::FrameSpec spec;
  CHECK(run::moments(spec, r.trace).size() == 8);
  spec.most = 3;
  const std::vector<trace::EventId> three = run::moments(spec, r.trace);
  REQUIRE(three.size() == 3);
  CHECK(three.front() == run::last_event(r.trace, 0));
  CHECK(three.back() == r.trace.events.size() - 1);
  spec.at = render::FrameSpec::At::none;
  CHECK(run::moments(spec, r.trace).empty());
  spec.at = render::FrameSpec::At::refinement;
  spec.most = 100'000;
  for (const trace::EventId e : run::moments(spec, r.trace))
    CHECK((r.trace.events[e].kind == EventKind::refine || r.trace.events[e].kind == EventKind::step));
  CHECK(run::evenly(10, 4) == std::vector<std::size_t>{0, 3, 6, 9});
  CHECK(run::evenly(2, 9) == std::vector<std::size_t>{0, 1});
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

TEST_CASE("the shipped collisions meet their expectations and agree with brute force") {
  for (const std::string& name : spec::shipped_names(spec::kScenarioEnding)) {
    const spec::Scenario s = spec::open_scenario(name);
    if (s.show != spec::Show::collision) continue;
    CAPTURE(s.name);
    CHECK_FALSE(s.expect.empty());
    const run::Recording r = run::record(s, run::kSilent);
    for (const std::string& line : run::mismatches(s, r)) FAIL_CHECK(line);
    const trace::Step& last = r.trace.steps.back();
    const BruteForceResult truth = brute_force(r.bodies[0].rep, last.pose_a, r.bodies[1].rep, last.pose_b);
    const CollideResult& answer = r.results.back();
    CHECK(truth.relation == answer.relation);
    if (!s.request.is_coarse()) {
      CHECK(truth.pairs == answer.pairs);
      continue;
    }
    CHECK(answer.error_bound > 0);
    std::size_t real = 0;
    for (const SimplexPair& p : answer.pairs) {
      if (!r.bodies[0].rep.is_real_simplex(p.a) || !r.bodies[1].rep.is_real_simplex(p.b)) continue;
      CHECK(std::binary_search(truth.pairs.begin(), truth.pairs.end(), p));
      ++real;
    }
    CHECK(real < answer.pairs.size());  // or it shows nothing
  }
}
