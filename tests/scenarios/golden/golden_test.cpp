/// Goldens catch what they are there for, and say what it is. The command: tests/commands/golden.txt.

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/golden/check.hpp"
#include "scenarios/golden/golden_report.hpp"
#include "tests/support/program.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/render/image.hpp>

namespace fs = std::filesystem;
using namespace lrb;
using namespace lrb::test;
using trace::runs::first_of;

namespace {

/// Two balls that meet; `frames` goes into the scenario's "frames".
std::string two_balls(const std::string& frames = {}) {
  return R"({"name": "balls", "purpose": "Two balls meet.",
 "bodies": {"a": {"generator": "ball", "parameters": {"frequency": 4}},
            "b": {"generator": "ball", "parameters": {"frequency": 4}}},
 "motion": {"kind": "approach", "from": [3, 0.2, 0.1], "before": 2, "into": 2},
 "frames": {"size": [480, 320])" +
         frames + "}}\n";
}

bool has(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

/// A folder with an approved golden of two_balls().
struct Approved : Folder {
  Approved() {
    write("balls.scenario.json", two_balls());
    const Outcome o = call("approve", {"--frames", "2", "balls.scenario.json"});
    REQUIRE_MESSAGE(o.code == 0, o.err);
  }
  Outcome call(const std::string& part, std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"golden", part});
    return test::run(*this, options);
  }
};

golden::GoldenSpec small_spec() {
  golden::GoldenSpec spec;
  spec.scenario = "balls";
  spec.width = 480;
  spec.height = 320;
  spec.frames = 1;
  return spec;
}

golden::GoldenRun play() {
  return golden::play_golden(spec::parse_scenario(two_balls(), "balls.scenario.json"), small_spec(),
                             record::kSilent);
}

/// The golden of a run, without going through files.
golden::Golden golden_of(const golden::GoldenRun& run) {
  golden::Golden golden;
  golden.name = run.scenario.name;
  golden.spec = small_spec();
  golden.facts = golden::facts_of(run);
  golden.trace = run.recording.trace;
  for (std::size_t i = 0; i < run.frames.size(); ++i)
    golden.frames.push_back(
        {{golden::golden_image_file(i), {run.frames[i].image, golden::golden_text(run, i), 0}, {}}});
  return golden;
}

/// As if an event had never been: all that follow, and all that they refer to, are one less.
void lose(trace::Trace& t, trace::EventId lost) {
  const std::size_t step = t.step_of(lost);
  t.events.erase(t.events.begin() + lost);
  for (trace::Event& e : t.events)
    if (e.cause != kNull && e.cause > lost) --e.cause;
  for (trace::Step& s : t.steps)
    if (s.first_event > lost) --s.first_event;
  --t.steps[step].events_seen;
  --t.events_seen;
}

}  // namespace

TEST_CASE("goldens: a changed colour fails, and is no moved camera; noise of processors passes") {
  const auto test_changed = [](void (*change)(render::Image&)) {
    const Approved folder;
    const std::string picture = folder / "goldens/balls/frame_1.png";
    render::DecodedPng png = render::read_png(picture);
    change(png.image);
    render::write_png(png.image, picture, {png.text, 0});
    return folder.call("test");
  };
  const Outcome colour = test_changed([](render::Image& image) {
    for (render::Rgba& p : image.pixels()) std::swap(p.r, p.b);
  });
  CHECK(colour.code == 1);
  CHECK(has(colour.out, "the camera is the same; most often #"));
  CHECK(has(colour.out, "images: 1 of 2 differ"));
  CHECK_FALSE(has(colour.out, "camera moved"));
  const Outcome noise = test_changed([](render::Image& image) {
    for (std::size_t i = 0; i < image.pixels().size(); i += 10) image.pixels()[i].g ^= 1;
    image.at(5, 5) = {0, 0, 0, 255};
  });
  CHECK(noise.code == 0);
  CHECK(has(noise.out, "images: 2 equal, 1 of them within tolerance"));
}

TEST_CASE("goldens: the circle is around a moved vertex, not around what differs most") {
  const golden::GoldenRun run = play();
  golden::Golden golden = golden_of(run);
  golden.meshes = {run.recording.bodies[0].rep.real_mesh()};
  golden.meshes[0]->vertices[0] *= 1.1;
  render::Image& approved = golden.frames[0][0].png.image;
  for (render::Rgba& p : approved.pixels()) p.g ^= 16;
  approved.fill({0, 0, 60, 60}, render::palette::kInk);
  const golden::GoldenResult result = golden::test_golden(golden, run, "", false);
  const render::Image found = render::decode_png(result.comparisons.at(0).pngs[2]).image;
  const auto first = std::ranges::find(found.pixels(), render::palette::kWrong);
  REQUIRE(first != found.pixels().end());
  CHECK(first - found.pixels().begin() >
        found.width());  // a circle around the corner begins in the first row
}

TEST_CASE("goldens: a variant passes; a changed picture loses its variants") {
  const Approved folder;
  const std::string base = folder / "goldens/balls/frame_1.png";
  render::DecodedPng png = render::read_png(base);
  png.image.fill({0, 0, 100, 100}, {1, 2, 3, 255});
  render::write_png(png.image, base, {png.text, 0});
  REQUIRE(folder.call("test").code == 1);
  CHECK(folder.call("approve", {"--variant", "here"}).code == 0);
  CHECK(fs::exists(folder / "goldens/balls/frame_1.here.png"));
  CHECK_FALSE(fs::exists(folder / "goldens/balls/frame_2.here.png"));
  CHECK(folder.call("test").code == 0);

  folder.write("balls.scenario.json", two_balls(R"(, "colour_by": "layer")"));
  CHECK(folder.call("test").code == 1);
  CHECK(folder.call("approve").code == 0);
  CHECK_FALSE(fs::exists(folder / "goldens/balls/frame_1.here.png"));
  CHECK(folder.call("test").code == 0);
}

TEST_CASE("goldens: lost, added and swapped events are reported as such") {
  golden::GoldenRun run = play();
  golden::Golden golden = golden_of(run);
  REQUIRE(golden::check_golden(golden, run).passed());
  const trace::EventId e = first_of(golden.trace, EventKind::contact);
  const std::string contact = trace::describe(golden.trace.events[e]);

  lose(run.recording.trace, e);
  const golden::GoldenResult lost = golden::test_golden(golden, run, "approve", false);
  CAPTURE(lost.verdict.diagnosis);
  REQUIRE(lost.verdict.divergence);
  CHECK(lost.verdict.divergence->event == e);
  CHECK(lost.verdict.diagnosis.starts_with("event " + std::to_string(e) + " lost: " + contact));
  CHECK(has(lost.verdict.diagnosis, "instead of"));
  CHECK(has(golden::result_text(lost), " lost: contact: "));
  REQUIRE(lost.comparisons.size() == 1);  // the pictures of the run are as approved
  CHECK_FALSE(lost.comparisons[0].pngs[0].empty());
  CHECK(lost.comparisons[0].pngs[0] != lost.comparisons[0].pngs[1]);

  std::swap(golden.trace, run.recording.trace);
  const golden::GoldenVerdict added = golden::check_golden(golden, run);
  REQUIRE(added.divergence);
  CHECK(added.diagnosis.starts_with("event " + std::to_string(e) + " added: " + contact));

  golden = golden_of(run);
  trace::EventId test = first_of(golden.trace, EventKind::face_test);
  const std::vector<trace::Event>& events = golden.trace.events;
  while (events[test].kind != EventKind::face_test || events[test + 1].kind != EventKind::face_test) ++test;
  std::swap(golden.trace.events[test], golden.trace.events[test + 1]);
  CHECK(has(golden::check_golden(golden, run).diagnosis,
            "events " + std::to_string(test) + " and " + std::to_string(test + 1) + " are swapped"));
}

TEST_CASE("goldens: inputs and counters are part of the run; a changed input is the cause") {
  const golden::GoldenRun run = play();
  struct Change {
    void (*apply)(golden::Golden&);
    const char *difference, *cause;
  };
  const Change changes[] = {
      {[](golden::Golden& g) { ++g.trace.steps[2].result.counters.box_tests; },
       "step 2: counter box_tests: expected ", "but the program runs differently"},
      {[](golden::Golden& g) { g.trace.header.request.contacts = false; },
       "request: contacts: expected false, found true", "the query request changed: contacts"},
      {[](golden::Golden& g) { g.trace.header.request.interiors_overlap = true; },
       "request: interiors_overlap: expected true, found false",
       "the query request changed: interiors_overlap"},
      {[](golden::Golden& g) { g.trace.steps[1].pose_b.t.x() += 1; }, "step 1: pose of B",
       "step 1: body B moved: its origin is displaced by 1"},
      {[](golden::Golden& g) {
         Pose& pose = g.trace.steps[2].pose_b;
         pose.r = Pose::rotation({0, 0, 1}, 0.5 * std::numbers::pi / 180).r * pose.r;
       },
       "step 2: pose of B", "step 2: body B moved: it is rotated by 0.5 degrees"},
      {[](golden::Golden& g) { g.trace.steps[2].pose_b.r *= 2; }, "step 2: pose of B",
       "step 2: body B moved: its matrix changed"},
      {[](golden::Golden& g) { ++g.trace.header.bodies[0].hash; }, "hash of body A",
       "the mesh is unchanged, but its LRB-rep was built differently"},
      {[](golden::Golden& g) { ++g.trace.header.bodies[0].hash, ++g.facts.meshes[0]; }, "hash of body A",
       "its mesh changed: "},
      {[](golden::Golden& g) { ++g.trace.header.bodies[0].hash, g.facts.meshes.clear(); }, "hash of body A",
       "its mesh or its LRB-rep changed"}};
  for (const Change& change : changes) {
    CAPTURE(change.cause);
    golden::Golden golden = golden_of(run);
    change.apply(golden);
    const golden::GoldenVerdict v = golden::check_golden(golden, run);
    REQUIRE(v.divergence);
    CHECK(has(v.divergence->message(), change.difference));
    CHECK(has(v.causes.at(0), change.cause));
  }
  golden::Golden golden = golden_of(run);
  ++golden.trace.header.bodies[1].hash;
  const golden::GoldenResult body = golden::test_golden(golden, run, "approve", false);
  REQUIRE(body.comparisons.size() == 1);
  CHECK(has(body.comparisons[0].text, "cannot be replayed"));
}

TEST_CASE("goldens: work has a budget") {
  const golden::GoldenRun run = play();
  golden::Golden golden = golden_of(run);
  golden.spec.levels = {false, false, false, true};
  CHECK(golden::check_golden(golden, run).passed());
  std::uint64_t sum = 0;
  for (trace::Step& step : golden.trace.steps) sum += step.result.counters.box_tests;
  REQUIRE(sum > 100);
  const auto approve_sum = [&](std::uint64_t wanted) {
    for (trace::Step& step : golden.trace.steps) step.result.counters.box_tests = 0;
    golden.trace.steps.back().result.counters.box_tests = wanted;
    return golden::test_golden(golden, run, "approve", false);
  };
  CHECK(approve_sum(sum).verdict.passed());
  CHECK(has(golden::result_text(approve_sum(sum)), "ok    balls: work within budget; images: not compared"));
  CHECK(approve_sum(10 * sum).verdict.passed());  // less work than approved
  golden.spec.work = 0.5;
  CHECK(approve_sum(sum * 2 / 3 + 1).verdict.passed());
  const golden::GoldenResult more = approve_sum(sum / 2);
  REQUIRE(more.verdict.more_work.size() == 1);
  CHECK(has(golden::result_text(more), "FAIL  balls: more work than allowed"));
  CHECK(has(golden::result_text(more), "work: box tests of all steps: approved " + std::to_string(sum / 2) +
                                           ", found " + std::to_string(sum) + ", more than 50 % more"));
  golden.spec.levels = {true, false, false, false};
  CHECK(golden::check_golden(golden, run).passed());
}

TEST_CASE("goldens: ignored and selected rectangles decide which pictures pass") {
  const golden::GoldenRun run = play();
  golden::Golden golden = golden_of(run);
  golden.spec.levels = {false, false, true, false};
  golden.frames[0][0].png.image.fill({100, 100, 80, 60}, {1, 200, 3, 255});
  const auto passes = [&] { return golden::check_golden(golden, run).passed(); };
  CHECK_FALSE(passes());
  golden.spec.ignore = {{90, 90, 100, 80}};
  CHECK(passes());
  CHECK(golden::check_golden(golden, run).images[0].equal);
  golden.spec.ignore = {{90, 90, 100, 80}, {0, 0, 10, 10}};
  CHECK(passes());
  golden.spec.ignore = {{0, 0, 10, 10}};
  CHECK_FALSE(passes());
  golden.spec.ignore.clear();
  golden.spec.only = {{0, 0, 90, 320}};
  CHECK(passes());
  golden.spec.only = {{0, 0, 120, 320}};
  CHECK_FALSE(passes());
  // Shares are of the compared pixels: few that differ are many of a small rectangle.
  golden.spec.only = {{100, 100, 4, 4}};
  CHECK(has(golden::check_golden(golden, run).images[0].text, "100 % of pixels differ"));
}

TEST_CASE("goldens: differences of scenarios are named by key") {
  const auto difference = [](const char* x, const char* y) {
    return golden::scenario_difference(golden::compact_json(x), golden::compact_json(y));
  };
  CHECK(difference(R"({"a": 1, "b": [1, 2]})", R"({ "b": [1,2], "a": 1 })").empty());
  CHECK(difference(R"({"a": {"b": 1, "c": 2}})", R"({"a": {"b": 1, "c": 3}})") == "a.c: 2 -> 3");
  CHECK(difference(R"({"v": [{"x": 1}, {"x": 2}]})", R"({"v": [{"x": 1}, {"x": 4, "y": 5}]})") ==
        "v[1].x: 2 -> 4; v[1].y: absent -> 5");
  CHECK(difference(R"({"v": [{"x": 1}]})", R"({"v": []})") == "v: [{\"x\":1}] -> []");
  CHECK(difference(R"({"a":1,"b":1,"c":1,"d":1})", R"({"a":2,"b":2,"c":2,"d":2})") ==
        "a: 1 -> 2; b: 1 -> 2; c: 1 -> 2; and 1 more");
}
