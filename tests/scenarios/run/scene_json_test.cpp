#include "scenarios/run/scene_json.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "render/pictures/marks.hpp"
#include "scenarios/frames/proof_map.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/report/assets.hpp"
#include "tests/support/approach.hpp"
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace.hpp>

using namespace lrb;
using nlohmann::json;

namespace {

record::Recording rocks_that_meet(WrapperMode mode = WrapperMode::regularised,
                                  EventLevel level = EventLevel::faces, bool measured = false) {
  spec::Scenario s = test::approach("rock", 6);
  s.events = level;
  s.request.wrapper = mode;
  if (mode == WrapperMode::unregularised) s.request.recursion = Recursion::paper;
  s.more.distance = measured;
  if (measured) s.more.clash.emplace();
  return record::record(s, record::kSilent);
}

frames::RecordedRun run_of(const record::Recording& r) {
  frames::RecordedRun p;
  p.trace = &r.trace;
  for (const bodies::LoadedBody& body : r.bodies) p.reps.push_back(&body.rep);
  return p;
}

bool changes_wrapper(const trace::Event& e) {
  return e.kind == EventKind::refine || e.kind == EventKind::coarsen;
}

std::size_t changes(const trace::Trace& trace) {
  return static_cast<std::size_t>(std::count_if(trace.events.begin(), trace.events.end(), changes_wrapper));
}

}  // namespace

TEST_CASE("thinned events: changes of wrappers have priority, and the first contact is kept") {
  const record::Recording r = rocks_that_meet();
  const std::size_t most = changes(r.trace) + 3 * r.trace.steps.size();
  REQUIRE(most < r.trace.events.size());
  const record::ThinnedEvents t = record::thin_events(r.trace, most);
  CHECK(t.kept.size() == most);
  CHECK(t.steps == r.trace.steps.size());
  CHECK_FALSE(t.cut);
  CHECK(std::is_sorted(t.kept.begin(), t.kept.end()));
  CHECK(static_cast<std::size_t>(std::count_if(t.kept.begin(), t.kept.end(), [&](trace::EventId e) {
          return changes_wrapper(r.trace.events[e]);
        })) == changes(r.trace));
  CHECK(std::binary_search(t.kept.begin(), t.kept.end(), record::first_contact(r.trace)));
}

TEST_CASE("thinned events: if even those are too many, entire steps are omitted") {
  const record::Recording r = rocks_that_meet();
  const record::ThinnedEvents t = record::thin_events(r.trace, changes(r.trace) / 2);
  CHECK(t.kept.size() <= changes(r.trace) / 2);
  CHECK(t.steps < r.trace.steps.size());
  CHECK_FALSE(t.cut);
  for (std::size_t s = 0; s < r.trace.steps.size(); ++s) {
    const trace::EventId first = r.trace.steps[s].first_event;
    const auto events = r.trace.events_of(s);
    const auto kept = [&](std::size_t i) {
      return std::binary_search(t.kept.begin(), t.kept.end(), static_cast<trace::EventId>(first + i));
    };
    for (std::size_t i = 0; i < events.size(); ++i)
      if (changes_wrapper(events[i])) CHECK(kept(i) == kept(0));
  }
  CHECK(std::binary_search(t.kept.begin(), t.kept.end(), record::first_contact(r.trace)));
}

TEST_CASE("thinned events: a refinement face by face keeps the test that caused it") {
  const record::Recording r = rocks_that_meet(WrapperMode::unregularised);
  const record::ThinnedEvents t = record::thin_events(r.trace, r.trace.events.size() - 1);
  std::size_t causes = 0;
  for (const trace::EventId id : t.kept) {
    const trace::Event& e = r.trace.events[id];
    if (!changes_wrapper(e) || e.cause == kNull) continue;
    ++causes;
    CHECK(std::binary_search(t.kept.begin(), t.kept.end(), e.cause));
  }
  CHECK(causes > 0);
}

TEST_CASE("boxes of tree nodes contain the faces, and each depth the boxes of the next") {
  const record::Recording r = rocks_that_meet();
  const LrbRep& rep = r.bodies[0].rep;
  const std::vector<pictures::TreeBox> boxes = pictures::tree_boxes(rep.tree(), 100'000);
  CHECK(boxes.size() == rep.tree().nodes().size());
  CHECK(boxes.back().depth + 1 == rep.tree().height());
  const auto holds = [](const pictures::TreeBox& box, const Eigen::Vector3d& x) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d axis = box.half.col(i);
      if (std::abs(axis.dot(x - box.centre)) > axis.squaredNorm() * (1 + 1e-6) + 1e-12) return false;
    }
    return true;
  };
  for (std::uint32_t depth = 0; depth < 2; ++depth)
    for (FaceId f = 0; f < rep.real_face_count(); ++f)
      for (const VertexId v : rep.face(f))
        CHECK(std::any_of(boxes.begin(), boxes.end(), [&](const pictures::TreeBox& b) {
          return b.depth == depth && holds(b, rep.vertices()[v]);
        }));
}

TEST_CASE("boxes of deep nodes: those on paths to faces, as many as fit, with the complete tree's boxes") {
  const record::Recording r = rocks_that_meet();
  const ObbTree& tree = r.bodies[0].rep.tree();
  const std::vector<pictures::TreeBox> all = pictures::tree_boxes(tree, 100'000);
  REQUIRE(tree.height() > 2);
  std::vector<SimplexId> simplices;
  for (SimplexId s = 0; s < r.bodies[0].rep.real_simplex_count(); ++s) simplices.push_back(s);
  const std::vector<pictures::TreeBox> deep = pictures::boxes_on_paths(tree, 0, simplices, 100'000);
  CHECK(deep.size() + 1 == all.size());  // every node is on the way to a face; the root is not below itself
  for (const pictures::TreeBox& box : deep) {
    const auto same = std::find_if(all.begin(), all.end(), [&](const auto& b) { return b.node == box.node; });
    REQUIRE(same != all.end());
    CHECK(same->depth == box.depth);
    CHECK(same->centre == box.centre);
    CHECK(same->half == box.half);
  }
  const auto one = pictures::boxes_on_paths(tree, 0, {SimplexId(0)}, 100'000);
  CHECK(one.size() >= 1);
  CHECK(one.size() < tree.height());
  CHECK(pictures::boxes_on_paths(tree, 0, simplices, 3).size() == 3);
  CHECK(pictures::boxes_on_paths(tree, 0, {SimplexId(1'000'000)}, 3).empty());  // no real simplex
  const std::vector<std::uint32_t> counts = pictures::nodes_by_depth(tree);
  CHECK(counts.size() == tree.height());
  CHECK(counts[0] == 1);
  CHECK(counts[1] == std::count_if(all.begin(), all.end(), [](const auto& b) { return b.depth == 1; }));
}

TEST_CASE("page data of a run names omissions and where to find them") {
  const record::Recording r = rocks_that_meet();
  run::SceneLimits limits;
  limits.events = 100;
  limits.faces = 10;
  limits.explained = {.pairs = 5, .steps = 1};
  const json scene = json::parse(run::scene_json(run_of(r), {"trace.json.gz", ""}, limits));
  CHECK(scene["events"]["count"] <= 100);
  CHECK(scene["events"]["id"] != "");
  const std::string thinned = scene["thinned"], large = scene["tooLarge"];
  CHECK(thinned.find("trace.json.gz contains all of them") != std::string::npos);
  CHECK(large.find("the limit for a page is 10") != std::string::npos);
  CHECK_FALSE(scene["bodies"][0].contains("geometry"));
  CHECK(scene["why"]["pairs"]["count"] == 5);
  CHECK(scene["why"]["steps"].size() == 1);
  CHECK(scene["why"]["cut"].get<std::string>().starts_with("This page explains 5 of the "));
}

TEST_CASE("a page has the proof maps of its own steps") {
  const record::Recording r = rocks_that_meet(WrapperMode::regularised, EventLevel::nodes);
  const frames::RecordedRun p = run_of(r);
  run::SceneLimits limits;
  limits.events = changes(r.trace) - 1;
  std::set<std::size_t> kept;
  for (const trace::EventId id : record::thin_events(r.trace, limits.events).kept)
    kept.insert(r.trace.step_of(id));
  REQUIRE(kept.size() < r.trace.steps.size());
  std::vector<std::uint32_t> first{0};
  for (const std::size_t step : kept) {
    std::size_t cells = first.back();
    if (const auto map = frames::proof_map(p, step))  // a pair that is tested waits for it
      for (const frames::MapCell& cell : map->cells)
        cells += cell.is_upon() && cell.argument != frames::Argument::planes ? 2 : 1;
    first.push_back(cells > 4 * limits.events ? first.back() : static_cast<std::uint32_t>(cells));
  }
  CHECK(first.back() > 0);
  const json scene = json::parse(run::scene_json(p, {"trace.json", ""}, limits));
  CHECK(scene["map"]["cells"]["first"] == report::packed(first));
}

TEST_CASE("page data of large bodies lacks pseudo faces that no wrapper shows") {
  const record::Recording r = rocks_that_meet();
  run::SceneLimits limits;
  limits.with_all_lids = 10;
  const json scene = json::parse(run::scene_json(run_of(r), {"trace.json", ""}, limits));
  for (const Side side : {Side::a, Side::b}) {
    const LrbRep& rep = r.bodies[static_cast<std::size_t>(side)].rep;
    const std::vector<std::uint32_t> shown = run::shown_pseudo_faces(rep, side, r.trace);
    CHECK(shown.size() < rep.face_count() - rep.real_face_count());
    CHECK(scene["bodies"][static_cast<std::size_t>(side)]["geometry"]["shown"] == report::packed(shown));
    std::set<std::uint32_t> needed;
    trace::Cursor cursor(r.trace, r.bodies[0].rep, r.bodies[1].rep);
    for (trace::EventId e = 0; e < r.trace.events.size(); ++e) {
      cursor.seek(e);
      for (const FaceId f : cursor.wrapper(side).boundary())
        if (!rep.is_real(f)) needed.insert(f.value());
    }
    CHECK(std::includes(shown.begin(), shown.end(), needed.begin(), needed.end()));
  }
}

TEST_CASE("page data of a run has the outcome of each event") {
  const record::Recording r = rocks_that_meet(WrapperMode::regularised, EventLevel::all);
  const json events = json::parse(run::scene_json(run_of(r), {"trace.json", ""}))["events"];
  const std::vector<std::string> words = events["outcomes"]["words"];
  std::set<std::string> expected;
  for (const trace::Event& e : r.trace.events) {
    if (e.kind == EventKind::face_test || e.kind == EventKind::contact) expected.emplace(name_of(e.meet));
    if (e.kind == EventKind::node_pair) expected.emplace(name_of(e.node_end().step));
    if (e.kind == EventKind::point) expected.emplace(name_of(e.where()));
  }
  CHECK(std::set<std::string>(words.begin(), words.end()) == expected);
  CHECK(words.size() == expected.size());
  CHECK(expected.count("cross") == 1);
  CHECK(expected.count(std::string(name_of(NodeStep::leaves))) == 1);
}

TEST_CASE("page data of a run explains each pair of a step once, and each step without pairs") {
  const record::Recording r = rocks_that_meet();
  const json why = json::parse(run::scene_json(run_of(r), {"trace.json", "lrbscope why --run x"}))["why"];
  std::set<std::array<std::uint32_t, 3>> pairs;
  std::size_t empty = 0;
  for (std::uint32_t s = 0; s < r.trace.steps.size(); ++s) {
    empty += r.trace.steps[s].result.pair_count == 0 ? 1 : 0;
    for (const trace::Event& e : r.trace.events_of(s))
      if (e.kind == EventKind::face_test) pairs.insert({s, e.a, e.b});
  }
  REQUIRE(empty > 0);
  CHECK(why["pairs"]["count"] == pairs.size());
  CHECK(why["steps"].size() == empty);
  CHECK(why["cut"] == "");
  CHECK(why["command"] == "lrbscope why --run x");
  for (const json& step : why["steps"]) {
    CHECK(step["relation"] == "separate");
    CHECK((step["roots"]["gap"] > 0 || !step["boxes"].is_null() || step["facePairs"] > 0));
    if (!step["plane"].is_null()) CHECK(step["plane"]["gap"] > 0);
  }
  // Of a captured query with a solid box, which its first face stands for, no face is explained.
  std::vector<CollideResult> exact(r.trace.steps.size());
  for (CollideResult& one : exact) one.pairs = {{SimplexId(0), SimplexId(0)}};
  const std::vector<record::WrongAnswer> right(exact.size());
  frames::RecordedRun captured = run_of(r);
  captured.results = &exact, captured.wrong = &right;
  CHECK(json::parse(run::scene_json(captured, {"trace.json", ""}))["why"]["pairs"]["count"] == 0);
}

TEST_CASE("page data of a run explains only answers of the complete query") {
  const record::Recording r = rocks_that_meet(WrapperMode::unregularised);
  CHECK(json::parse(run::scene_json(run_of(r), {"trace.json", ""}))["why"].is_null());
}

TEST_CASE("page data of a run has a segment for each measured step with separate or overlapping bodies") {
  const auto scene_of = [](const record::Recording& r) {
    return json::parse(run::scene_json(run_of(r), {"trace.json", ""}));
  };
  CHECK(scene_of(rocks_that_meet())["measured"].is_null());
  const record::Recording r = rocks_that_meet(WrapperMode::regularised, EventLevel::faces, true);
  const json measured = scene_of(r)["measured"];
  std::vector<std::string> wanted;
  for (const trace::Step& s : r.trace.steps) {
    if (s.result.distance->lower > 0) wanted.emplace_back("distance ");
    if ((*s.result.clash->depth)[1] > 0) wanted.emplace_back("depth ");
  }
  CHECK(std::count(wanted.begin(), wanted.end(), "distance ") == 3);
  CHECK(std::count(wanted.begin(), wanted.end(), "depth ") == 5);
  REQUIRE(measured["words"].size() == wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    CHECK(measured["words"][i].get<std::string>().starts_with(wanted[i]));
  std::vector<std::uint32_t> kinds;
  for (const std::string& text : wanted) kinds.push_back(text == "depth " ? 1 : 0);
  CHECK(measured["kind"] == report::packed(kinds));
}
