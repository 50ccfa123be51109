/// Captures of other engines as recorded runs: bodies of any kind, broken trees, wrong answers, and the
/// command that imports them.

#include "scenarios/profile/captured_run.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "scenarios/record/engine_run.hpp"
#include "tests/matrix/bodies.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/toy_engine.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::test {
namespace {

const matrix::Matrix& kinds_of_bodies() {
  static const matrix::Matrix all = matrix::make_matrix(0);
  return all;
}

bool is_of_triangles(const Mesh& mesh) {
  return mesh.dim == 3 && mesh.face_vertices.size() == 3 * mesh.face_count();
}

/// Meshes that engines are given, sound or not: those of the matrix, and what only engines have.
std::vector<capture::Mesh> meshes_of_all_kinds() {
  std::vector<capture::Mesh> out;
  for (const matrix::Kind& kind : kinds_of_bodies().kinds)
    if (is_of_triangles(kind.mesh)) out.push_back(captured(kind.mesh, kind.name));
  capture::Mesh degenerate = captured(shapes::tetrahedron(), "two corners or all are one");
  degenerate.triangles.insert(degenerate.triangles.begin(), {2, 2, 3});
  degenerate.triangles.push_back({1, 1, 1});
  out.push_back(degenerate);
  out.push_back(captured(as_soup(shapes::box()), "soup"));
  return out;
}

record::Recording recorded(const capture::Capture& c, const profile::TreePair& pair,
                           profile::CapturedRunSettings settings = {}) {
  settings.scenario = "test";
  std::vector<bodies::LoadedBody> bodies;
  for (const std::uint32_t tree : pair.trees)
    bodies.push_back(profile::captured_body(c.meshes[c.trees[tree].mesh]));
  return profile::captured_run(c, pair, std::move(bodies), settings, record::kSilent);
}

record::Recording recorded(const capture::Capture& c) {
  const profile::TreePairs pairs = profile::tree_pairs(c);
  REQUIRE(pairs.pairs.size() == 1);
  return recorded(c, pairs.pairs[0]);
}

/// A query of two balls with everything right.
ToyEngine two_balls() {
  ToyEngine engine;
  const std::uint32_t a = engine.add(captured(shapes::icosphere(2), "a")),
                      b = engine.add(captured(shapes::icosphere(2), "b"), 4);
  REQUIRE(engine.query(a, b, {1.5, 0.25, 0.125}) > 20);
  return engine;
}

}  // namespace

TEST_CASE("a captured mesh of any kind becomes a body; a triangle soup may be closed") {
  for (const capture::Mesh& mesh : meshes_of_all_kinds()) {
    CAPTURE(mesh.name);
    const bodies::LoadedBody body = profile::captured_body(mesh);
    CHECK(body.rep.real_simplex_count() == mesh.triangles.size());
    if (mesh.name == "soup") CHECK(body.rep.closed());
    CHECK(body.notes.empty() == body.rep.closed());
  }
}

TEST_CASE("a mesh without triangles, or with a coordinate that is not finite, is refused in one line") {
  CHECK_THROWS_AS(profile::captured_body({"empty", {{0, 0, 0}}, {}}), InputError);
  CHECK_THROWS_AS(profile::captured_body({"nan", {{0, 0, 0}, {1, 0, 0}, {0, HUGE_VAL, 0}}, {{0, 1, 2}}}),
                  InputError);
}

TEST_CASE("for bodies of any kind, found pairs are right and the others that meet are missed") {
  std::uint64_t all_right = 0,
                all_undecidable = 0;  // its boxes are rounded: some that touch are lost
  for (const matrix::Cell& cell : kinds_of_bodies().cells) {
    const matrix::Kind &a = kinds_of_bodies().kinds[cell.a], &b = kinds_of_bodies().kinds[cell.b];
    if (!is_of_triangles(a.mesh) || !is_of_triangles(b.mesh)) continue;
    CAPTURE(a.name);
    CAPTURE(b.name);
    ToyEngine engine;
    const std::uint32_t tree_a = engine.add(captured(a.mesh)), tree_b = engine.add(captured(b.mesh), 1);
    std::uint64_t found = 0, meeting = 0;
    for (const matrix::Step& step : cell.steps) {
      for (const capture::Event& e : engine.ask(tree_a, {}, tree_b, step.pose).events)
        found += e.kind == capture::EventKind::triangles && e.met != 0;
      meeting += step.truth.pairs.size();
    }
    const record::EngineTotals totals = record::totals_of(recorded(engine.capture));
    CHECK(totals.right == found);
    CHECK(totals.right + totals.missed + totals.undecidable == meeting);
    CHECK(totals.false_pairs == 0);
    CHECK(totals.queries == cell.steps.size());
    all_right += found;
    all_undecidable += totals.undecidable;
  }
  CHECK(all_right > 1000);
  CHECK(all_undecidable > 0);
}

TEST_CASE("a captured walk becomes a trace: which pair led to which, and what met") {
  ToyEngine engine;
  const std::uint32_t tree = engine.add(captured(shapes::tetrahedron()), 1);
  REQUIRE(engine.capture.trees[tree].size() == 7);  // nodes 1 and 2 below the root, leaves 3 to 6
  capture::Query q;
  q.number = 7;
  q.trees = {tree, tree};
  q.poses[1] = Pose::translation({0.125, 0.125, 0.125});
  q.ended = true;
  using capture::EventKind;
  const std::uint32_t leaf = engine.capture.trees[tree].triangles(3)[0];
  // Both roots; A's first node; B's first node; two leaves of these, tested; the rest apart.
  q.events = {{0, 0, EventKind::nodes, 1}, {1, 0, EventKind::nodes, 1}, {1, 1, EventKind::nodes, 1},
              {3, 1, EventKind::nodes, 1}, {3, 3, EventKind::nodes, 1}, {leaf, leaf, EventKind::triangles, 1},
              {3, 4, EventKind::nodes, 0}, {4, 1, EventKind::nodes, 0}, {1, 2, EventKind::nodes, 0},
              {2, 0, EventKind::nodes, 0}};
  q.events_seen = q.events.size();
  q.parts = {{0, 0, q.events.size()}};
  engine.capture.queries = {q};
  const record::Recording run = recorded(engine.capture);
  std::vector<std::array<std::uint32_t, 5>> found;  // a, b, parent's a, parent's b, met
  for (const trace::Event& e : run.trace.events) {
    if (e.kind != lrb::EventKind::node_pair) continue;
    const trace::Event* above = e.cause == kNull ? nullptr : &run.trace.events[e.cause];
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
  const trace::Step& step = run.trace.steps.at(0);
  CHECK(step.index == 7);
  CHECK(step.result.counters.box_tests == 9);
  CHECK(step.result.counters.face_tests == 1);
  CHECK(step.result.pair_count == 1);
  CHECK(run.trace.header.engine == "Toy 1.0");
  CHECK(trace::trace_from_json(trace::trace_to_json(run.trace), "t.json") == run.trace);
  const trace::NodeCounts counts = trace::count_nodes(run.trees[0], Side::a, run.trace.events);
  CHECK(counts.visits == std::vector<std::uint32_t>{1, 3, 1, 3, 1, 0, 0});
}

TEST_CASE("tests of triangles without a test of their volumes get a path from the root") {
  ToyEngine engine;
  const std::uint32_t tree = engine.add(captured(shapes::tetrahedron()), 1);
  const capture::Tree& t = engine.capture.trees[tree];
  capture::Query q;
  q.number = 1;
  q.trees = {tree, tree};
  using capture::EventKind;
  const std::uint32_t s = t.triangles(3)[0], left = t.triangles(3)[0], right = t.triangles(4)[0];
  q.events = {
      {3, 1, EventKind::nodes, 1}, {s, left, EventKind::triangles, 0}, {s, right, EventKind::triangles, 1}};
  engine.capture.queries = {q};
  const record::Recording run = recorded(engine.capture);
  const auto pair = std::find_if(run.trace.events.begin(), run.trace.events.end(),
                                 [](const trace::Event& e) { return e.kind == lrb::EventKind::node_pair; });
  REQUIRE(pair != run.trace.events.end());
  CHECK(pair->work().met == 2);
  CHECK(pair->node_end().step == NodeStep::descend_b);
}

TEST_CASE("boxes, axes, wide tests, counters and phases of a capture are those of the trace") {
  ToyEngine engine = two_balls();
  engine.capture.names = {"cache misses", "descent"};
  capture::Query& q = engine.capture.queries[0];
  q.events.insert(q.events.begin(), {1, 0, capture::EventKind::phase});
  q.events.push_back({0, 77, capture::EventKind::count});
  q.events[1].tests = 4, q.events[1].met = 1, q.events[1].axis = 2;
  q.events_seen = q.parts[0].count = q.events.size();
  const record::Recording run = recorded(engine.capture);
  const trace::EngineReport& report = run.trace.steps[0].result.engine.value();
  CHECK(report.verdict == trace::EngineVerdict::intersecting);
  CHECK(report.pairs == q.pairs);
  CHECK(report.begin_ns == 1000);
  CHECK(report.duration_ns == 500);
  CHECK(report.complete);
  CHECK((report.phases == std::vector<trace::EngineReport::Mark>{{1, 2, 0}}));  // after step and begin
  CHECK(report.counts.at(0).value == 77);
  CHECK(run.trace.header.names == engine.capture.names);
  std::size_t i = 1;  // of the query's events, without its phase
  for (const trace::Event& e : run.trace.events) {
    if (e.kind != lrb::EventKind::node_pair) continue;
    while (q.events[i].kind != capture::EventKind::nodes) ++i;
    CHECK(e.node_pair().engine_axis == (q.events[i].axis == capture::kNoAxis ? 0 : q.events[i].axis + 1));
    CHECK(e.work().box_tests == q.events[i].tests);
    ++i;
  }
  for (std::uint32_t n = 0; n < run.trees[0].size(); ++n) {
    const auto volume = engine.capture.trees[0].volume_of(n);
    const trace::ShapeBox& box = run.trees[0].box(n);
    for (int k = 0; k < 3; ++k) {
      CHECK(box.centre[k] - box.half[static_cast<std::size_t>(k)][k] ==
            doctest::Approx(volume[static_cast<std::size_t>(k)]));
      CHECK(box.centre[k] + box.half[static_cast<std::size_t>(k)][k] ==
            doctest::Approx(volume[static_cast<std::size_t>(k + 3)]));
    }
  }
}

TEST_CASE("wrong answers are found pair by pair: those missed, those that are false") {
  ToyEngine engine;
  const std::uint32_t a = engine.add(captured(shapes::icosphere(2), "a")),
                      b = engine.add(captured(shapes::icosphere(2), "b"));
  std::vector<pictures::WrongPair> planted;
  std::uint32_t tested = 0;
  engine.wrong = [&](std::uint32_t s, std::uint32_t t, bool meets) {
    if (++tested % 7 != 0) return meets;
    planted.push_back({{SimplexId(s), SimplexId(t)}, meets});
    return !meets;
  };
  engine.query(a, b, {1.5, 0.25, 0.125});
  std::uint64_t missed = 0;
  for (const pictures::WrongPair& w : planted) missed += w.missed;
  REQUIRE(missed > 3);
  REQUIRE(planted.size() - missed > 3);
  const record::Recording run = recorded(engine.capture);
  REQUIRE(run.wrong.size() == 1);
  CHECK(run.wrong[0].pairs.size() == planted.size());
  for (const pictures::WrongPair& w : planted)
    CHECK(std::count_if(
              run.wrong[0].pairs.begin(), run.wrong[0].pairs.end(),
              [&](const pictures::WrongPair& x) { return x.pair == w.pair && x.missed == w.missed; }) == 1);
  const record::EngineTotals totals = record::totals_of(run);
  CHECK(totals.missed == missed);
  CHECK(totals.false_pairs == planted.size() - missed);
  CHECK(totals.right + missed == run.results[0].pairs.size());
  CHECK(totals.node_pairs + totals.face_tests == engine.capture.queries[0].events.size());
  CHECK(totals.words() == "wrong answers in 1 of 1 queries: " + std::to_string(missed) + " of " +
                              std::to_string(totals.right + missed) + " intersecting pairs missed, " +
                              std::to_string(totals.false_pairs) + " false pairs");
}

TEST_CASE("what counts as wrong depends on the kind of query") {
  using capture::QueryKind, capture::Verdict;
  struct Case {
    QueryKind kind;
    Verdict verdict;
    bool keeps_pairs;  // false: the engine found none
    bool is_missed, is_wrong_verdict;
  };
  const Case cases[] = {{QueryKind::all_pairs, Verdict::intersecting, true, false, false},
                        {QueryKind::all_pairs, Verdict::intersecting, false, true, false},
                        {QueryKind::all_pairs, Verdict::separate, false, true, true},
                        {QueryKind::any, Verdict::intersecting, false, false, false},
                        {QueryKind::any, Verdict::separate, false, true, true},
                        {QueryKind::any, Verdict::unreported, false, true, false},
                        {QueryKind::distance, Verdict::separate, false, true, true},
                        {QueryKind::distance, Verdict::intersecting, true, false, false},
                        {QueryKind::first_contact, Verdict::separate, false, false, false},
                        {QueryKind::self, Verdict::separate, false, false, false}};
  for (const Case& c : cases) {
    CAPTURE(static_cast<int>(c.kind));
    CAPTURE(static_cast<int>(c.verdict));
    ToyEngine engine = two_balls();
    capture::Query& q = engine.capture.queries[0];
    q.kind = c.kind;
    q.verdict = c.verdict;
    if (!c.keeps_pairs)
      for (capture::Event& e : q.events)
        if (e.kind == capture::EventKind::triangles) e.met = 0;
    const record::Recording run = recorded(engine.capture);
    const record::EngineTotals totals = record::totals_of(run);
    CHECK((totals.missed > 0) == c.is_missed);
    CHECK(totals.false_pairs == 0);
    CHECK(totals.wrong_verdicts == c.is_wrong_verdict);
    CHECK((run.trace.steps[0].result.distance.has_value()) == (c.kind == QueryKind::distance));
    if (c.kind != QueryKind::distance) continue;
    for (const double value : {0.0, 1.5}) {  // they intersect
      q.value = {value, value};
      const record::EngineTotals valued = record::totals_of(recorded(engine.capture));
      CHECK(valued.wrong_distances == (value > 0));
      CHECK(valued.distances == 1);
    }
  }
}

TEST_CASE("a query without all its events, or without tests of triangles, is not said to miss pairs") {
  ToyEngine engine = two_balls();
  capture::Query& q = engine.capture.queries[0];
  std::erase_if(q.events, [](const capture::Event& e) { return e.kind == capture::EventKind::triangles; });
  FaultyEngine::close(q);
  REQUIRE(q.complete());
  CHECK(record::totals_of(recorded(engine.capture)).missed == 0);
  CHECK(record::totals_of(recorded(engine.capture)).wrong_verdicts == 0);
  q.events.clear();
  q.parts.clear();
  q.events_seen = 1;
  record::Recording run = recorded(engine.capture);
  CHECK(record::totals_of(run).missed == 0);
  CHECK_FALSE(run.trace.steps[0].result.engine->complete);
  CHECK(
      profile::captured_words(engine.capture, profile::tree_pairs(engine.capture).pairs[0]).find("1 query") !=
      std::string::npos);
  CHECK(record::totals_of(run).words() == "no wrong answer in 1 query: 1 verdict");
  q.verdict = capture::Verdict::separate;  // but its verdict is its own
  run = recorded(engine.capture);
  CHECK(record::totals_of(run).missed == run.results[0].pairs.size());
  CHECK(record::totals_of(run).wrong_verdicts == 1);
}

TEST_CASE("a walk over a broken tree is recorded with what holds") {
  ToyEngine engine = two_balls();
  const std::size_t whole = recorded(engine.capture).trace.events.size();
  capture::Tree& tree = engine.capture.trees[0];
  // Two leaves: one gets a triangle that does not exist in place of its own, one a second parent.
  std::uint32_t leaf = 0;
  while (!tree.is_leaf(leaf)) ++leaf;
  const std::uint32_t lost = tree.triangle[tree.first_triangle[leaf]];
  tree.triangle[tree.first_triangle[leaf]] = 5000;
  std::uint32_t deep = static_cast<std::uint32_t>(tree.size() - 1);
  const std::uint32_t orphan = tree.child[tree.first_child[0]];
  tree.child[tree.first_child[0]] = deep;
  const record::Recording run = recorded(engine.capture);
  CHECK(run.trace.events.size() == whole);
  CHECK(trace::trace_from_json(trace::trace_to_json(run.trace), "t.json") == run.trace);
  CHECK(run.trees[0].depth(orphan) == kNull);
  std::string notes;
  for (const std::string& note : run.notes) notes += note + "\n";
  CAPTURE(notes);
  CHECK(notes.find("tree A: 1 link to a node with another parent is left out") != std::string::npos);
  CHECK(notes.find("nodes are not below the root") != std::string::npos);
  CHECK(notes.find("tree A: 1 triangle of a leaf does not exist") != std::string::npos);
  CHECK(notes.find("tree A: 1 triangle is in no leaf") != std::string::npos);
  CHECK(lost < 320);
  // Figures of the tree still add up for the part that the root reaches.
  const trace::NodeCounts counts = trace::count_nodes(run.trees[0], Side::a, run.trace.events);
  const std::vector<double> values = trace::box_tests_by_face(run.bodies[0].rep, run.trees[0], counts);
  for (const double v : values) CHECK(std::isfinite(v));
}

TEST_CASE("a run for each pair of trees; queries without a second tree are counted") {
  ToyEngine engine;
  std::vector<std::uint32_t> trees;
  for (int i = 0; i < 3; ++i) trees.push_back(engine.add(captured(shapes::box())));
  engine.query(trees[0], trees[1], {0.5, 0.5, 0.5});
  engine.query(trees[1], trees[2], {0.5, 0.5, 0.5});
  engine.query(trees[0], trees[1], {3, 0, 0});
  engine.query(trees[1], trees[0], {0.5, 0, 0});
  engine.query(trees[0], trees[1], {0.25, 0.5, 0.5});
  engine.capture.queries[4].trees[0] = kNull;
  const profile::TreePairs found = profile::tree_pairs(engine.capture);
  REQUIRE(found.pairs.size() == 3);
  CHECK(found.without_tree == 1);
  CHECK(found.pairs[0].queries == std::vector<std::size_t>{0, 2});
  CHECK((found.pairs[2].trees == std::array<std::uint32_t, 2>{trees[1], trees[0]}));
  const record::Recording run = recorded(engine.capture, found.pairs[0]);
  CHECK(run.trace.steps.at(1).index == 3);
}

TEST_CASE("beyond the limit of events a trace is cut, with a note; answers stay compared") {
  const ToyEngine engine = two_balls();
  profile::CapturedRunSettings settings;
  settings.event_cap = 50;
  const record::Recording run =
      recorded(engine.capture, profile::tree_pairs(engine.capture).pairs[0], settings);
  CHECK(run.trace.events.size() == 50);
  REQUIRE(run.notes.size() == 1);
  CHECK(run.notes[0].find("the first 50 of ") != std::string::npos);
  CHECK(record::totals_of(run).missed == 0);
  CHECK(record::totals_of(run).right == engine.capture.queries[0].pairs);
}

TEST_CASE("trees of an engine survive a file, which is checked when it is read") {
  const record::Recording run = recorded(two_balls().capture);
  const std::string text = record::trees_text(run.trees);
  const auto trees = record::read_trees(text, "trees.json", {320, 320});
  REQUIRE(trees.size() == 2);
  CHECK(record::trees_text(trees) == text);
  const auto refuses = [&](const std::string& bad) {
    CHECK_THROWS_AS(record::read_trees(bad, "trees.json", {320, 320}), InputError);
  };
  CHECK_THROWS_AS(record::read_trees(text, "trees.json", {320, 319}), InputError);
  refuses("");
  refuses("[]");
  refuses(text.substr(0, text.size() / 2));
  nlohmann::json document = nlohmann::json::parse(text);
  document["trees"][1]["children"][0] = {1, 100000};
  refuses(document.dump());
  document["trees"][1]["children"][0] = {1, -1};
  refuses(document.dump());
  document["trees"].erase(1);
  refuses(document.dump());
}

}  // namespace lrb::test
