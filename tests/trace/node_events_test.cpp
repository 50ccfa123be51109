/// Events of an observed traversal: pairs of tree nodes, planes, points and phases.

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/answer_content.hpp"
#include "tests/support/trace_schema.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace_json.hpp>
#include <lrbscope/trace/work.hpp>
#include <lrbscope/wrapper.hpp>

using namespace lrb;
using namespace lrb::trace;
using Json = nlohmann::json;
using runs::BodyPair, runs::Recorded;

namespace {

const std::vector<BodyPair>& watched_bodies() {
  static const LrbRep rock = build_lrb(shapes::bumpy_sphere(3, 7, 0.3)),
                      ring = build_lrb(shapes::torus(24, 12)), gear = build_lrb(shapes::gear(20)),
                      box = build_lrb(shapes::box());
  static const std::vector<BodyPair> all = {{&rock, &ring}, {&rock, &rock}, {&gear, &gear}, {&ring, &box}};
  return all;
}

/// Also at the very same place, and by the kernel for affine maps.
Recorded record(const BodyPair& bodies, const CollideRequest& request, EventLevel level) {
  return runs::record(bodies, request, level, 5, 6, [](int step, Pose& pose) {
    if (step == 0) pose = {};
    if (step == 1) pose.r *= 1.5;
  });
}

std::vector<CollideRequest> requests() {
  return {{},
          {.mode = Mode::first_pair},
          {.mode = Mode::any_pair},
          {.contacts = true},
          {.tolerance = 0.2},
          {.separation = true}};
}

bool is_more(const Event& e) {
  return e.kind > EventKind::result;
}

}  // namespace

TEST_CASE("a query does the same work at every event detail") {
  for (const BodyPair& bodies : watched_bodies())
    for (const CollideRequest& request : requests()) {
      const Recorded faces = record(bodies, request, EventLevel::faces);
      for (const EventLevel level : {EventLevel::nodes, EventLevel::all}) {
        const Recorded more = record(bodies, request, level);
        for (std::size_t i = 0; i < faces.results.size(); ++i)
          CHECK((test::content(more.results[i]) == test::content(faces.results[i])));
        std::vector<Event> same = more.trace.events;
        std::erase_if(same, is_more);
        REQUIRE(same.size() == faces.trace.events.size());
        for (std::size_t i = 0; i < same.size(); ++i) {
          CHECK(same[i].kind == faces.trace.events[i].kind);
          CHECK(same[i].a == faces.trace.events[i].a);
          CHECK(same[i].b == faces.trace.events[i].b);
          CHECK(same[i].boundary == faces.trace.events[i].boundary);
          CHECK(same[i].depth_a == faces.trace.events[i].depth_a);
          CHECK(same[i].depth_b == faces.trace.events[i].depth_b);
          if (same[i].kind == EventKind::face_test) CHECK(same[i].tested_by() != TestedBy::unreported);
        }
      }
    }
}

TEST_CASE("observed coherent queries have the same answers and counters, and their events add up to these") {
  std::map<Phase, std::uint64_t> phases;
  std::uint64_t refined_again = 0, taken_back = 0;
  for (const BodyPair& bodies : watched_bodies())
    for (const Mode mode : {Mode::all_pairs, Mode::first_pair, Mode::any_pair}) {
      const CollideRequest request{.mode = mode, .contacts = mode == Mode::all_pairs};
      CoherentQuery alone(*bodies.a, *bodies.b, request, CoherentQuery::CacheUse::always),
          watched(*bodies.a, *bodies.b, request, CoherentQuery::CacheUse::always);
      RecorderSettings settings;
      settings.request = request;
      settings.level = EventLevel::all;
      settings.coherent = true;
      Recorder recorder(*bodies.a, *bodies.b, settings);
      std::vector<CollideResult> results;
      for (std::uint32_t i = 0; i < 16; ++i) {
        Pose pose = Pose::rotation({0, 0, 1}, 0.01 * i);
        pose.t = {0.5 + 0.02 * i + (i > 10 ? 0.3 : 0), 0.1, 0};  // straight on, but for a jump
        recorder.begin_step(i, {}, pose);
        results.push_back(watched.collide({}, pose, recorder));
        recorder.end_step(results.back());
        CHECK((test::content(results.back()) == test::content(alone.collide({}, pose))));
      }
      CHECK(watched.statistics().from_cache == alone.statistics().from_cache);
      const Trace t = recorder.take();
      check_trace(t, "t");
      CHECK(t == trace_from_json(trace_to_json(t), "t.json"));
      CHECK(test::trace_faults(Json::parse(trace_to_json(t))) == "");
      Cursor cursor(t, *bodies.a, *bodies.b);  // throws where a wrapper does not come out as recorded
      for (std::size_t step = 0; step < results.size(); ++step) {
        std::uint64_t pairs = 0, boxes = 0, tests = 0, unreported = 0;
        std::vector<SimplexPair> contacts;
        std::size_t opened = 0;
        bool again = false;
        for (const Event& e : t.events_of(step)) {
          pairs += e.kind == EventKind::node_pair;
          boxes += e.kind == EventKind::node_pair ? e.work().box_tests : 0;
          tests += e.kind == EventKind::face_test;
          unreported += e.kind == EventKind::face_test && e.tested_by() == TestedBy::unreported;
          if (e.kind == EventKind::contact) contacts.push_back({e.simplex(Side::a), e.simplex(Side::b)});
          if (e.kind == EventKind::begin) {
            ++phases[e.phase()];
            again = e.phase() == Phase::kept;
          }
          if (e.kind == EventKind::end) again = false;
          refined_again += e.kind == EventKind::refine && again;
          taken_back += e.kind == EventKind::coarsen;
          opened += e.kind == EventKind::refine;
          opened -= e.kind == EventKind::coarsen;
        }
        CHECK(pairs == results[step].counters.node_pairs);
        CHECK(boxes == results[step].counters.box_tests);
        CHECK(tests == results[step].counters.face_tests);
        CHECK(unreported == 0);
        CHECK(opened == results[step].opened[0].size() + results[step].opened[1].size());
        std::sort(contacts.begin(), contacts.end());
        if (mode == Mode::all_pairs) CHECK((contacts == results[step].pairs));
        cursor.seek(static_cast<EventId>(t.steps[step].first_event + t.events_of(step).size() - 1));
      }
    }
  for (const Phase p :
       {Phase::walk, Phase::relation, Phase::contacts, Phase::kept, Phase::cache, Phase::cached})
    CHECK(phases[p] > 0);
  CHECK(refined_again > 0);
  CHECK(taken_back > 0);
}

TEST_CASE("the events of a step add up to its counters") {
  std::set<NodeStep> seen;
  std::uint64_t apart = 0, inside_apart = 0, planes = 0, expansions = 0;
  for (const BodyPair& bodies : watched_bodies())
    for (const CollideRequest& request : requests()) {
      const Recorded run = record(bodies, request, EventLevel::all);
      for (std::size_t step = 0; step < run.results.size(); ++step) {
        std::uint64_t pairs = 0, boxes = 0, met = 0, rejected = 0, plane_tests = 0, reported = 0;
        for (const Event& e : run.trace.events_of(step)) {
          plane_tests += e.kind == EventKind::plane_test;
          expansions += e.kind == EventKind::face_test && e.tested_by() == TestedBy::expansions;
          if (e.kind == EventKind::end && e.phase() == Phase::walk) reported += e.b;
          if (e.kind != EventKind::node_pair) continue;
          const NodeWork work = e.work();
          ++pairs;
          boxes += work.box_tests;
          seen.insert(e.node_end().step);
          if (e.node_end().step == NodeStep::leaves) {
            met += work.met;
            rejected += work.rejected;
            CHECK(work.rejected + work.certain <= work.met);
          }
          if (work.met == 0) ++(e.node_end().apart ? apart : inside_apart);
        }
        const Counters& c = run.results[step].counters;
        CHECK(pairs == c.node_pairs);
        CHECK(reported == c.node_pairs);
        CHECK(boxes == c.box_tests);
        CHECK(met == c.prefilter_tests);
        CHECK(plane_tests == rejected);
        if (request.mode == Mode::all_pairs && !request.is_coarse()) CHECK(met - rejected == c.face_tests);
        planes += plane_tests;
      }
    }
  for (const NodeStep step : {NodeStep::descend_both, NodeStep::descend_a, NodeStep::leaves, NodeStep::whole})
    CHECK(seen.count(step) == 1);
  CHECK(apart > 100);
  CHECK(inside_apart > 100);
  CHECK(planes > 1000);
  CHECK(expansions > 0);
}

TEST_CASE("pairs of nodes form a tree: each pair's children are the overlapping ones, one level below") {
  for (const BodyPair& bodies : watched_bodies()) {
    const Trace t = record(bodies, {}, EventLevel::nodes).trace;
    std::map<EventId, std::uint32_t> children;
    for (EventId i = 0; i < t.events.size(); ++i) {
      const Event& e = t.events[i];
      if (e.kind != EventKind::node_pair) continue;
      if (e.cause == kNull) {
        CHECK((e.a == 0 && e.b == 0 && e.depth_a == 0));
        continue;
      }
      ++children[e.cause];
      const Event& above = t.events[e.cause];
      REQUIRE(above.kind == EventKind::node_pair);
      CHECK(e.depth_a == above.depth_a + 1);
      const NodeStep step = above.node_end().step;
      const auto is_child = [](const LrbRep& rep, std::uint32_t parent, std::uint32_t child) {
        const TreeNode& n = rep.tree().nodes()[parent];
        return !n.is_leaf && child >= n.first && child < n.first + n.count;
      };
      CHECK((step == NodeStep::descend_b ? e.a == above.a : is_child(*bodies.a, above.a, e.a)));
      CHECK((step == NodeStep::descend_a ? e.b == above.b : is_child(*bodies.b, above.b, e.b)));
    }
    for (EventId i = 0; i < t.events.size(); ++i)
      if (t.events[i].kind == EventKind::node_pair && t.events[i].node_end().step != NodeStep::leaves)
        CHECK(children[i] == t.events[i].work().met);
  }
}

TEST_CASE("traversals of levels of detail name the level, and are not counted for the body") {
  static const LrbRep rock = build_lrb(shapes::bumpy_sphere(4, 7, 0.3));
  RecorderSettings settings;
  settings.level = EventLevel::nodes;
  settings.request.tolerance = 0.3;
  Recorder recorder(rock, rock, settings);
  QueryContext context;
  const Pose pose = Pose::translation({0.7, 0.2, 0.1});
  recorder.begin_step(0, {}, pose);
  recorder.end_step(collide(rock, {}, rock, pose, settings.request, context, recorder));
  const Trace t = recorder.take();
  std::uint64_t of_body = 0, of_levels = 0;
  std::uint32_t walked = 0;
  for (const Event& e : t.events) {
    if (e.kind == EventKind::begin && e.phase() == Phase::walk) {
      walked = e.depth_a;
      CHECK(walked <= rock.levels().all().size());
    }
    if (e.kind != EventKind::node_pair) continue;
    ++(walked == 0 ? of_body : of_levels);
    CHECK(e.a < walked_tree(rock, walked).nodes().size());
  }
  CHECK(of_body > 0);
  CHECK(of_levels > 0);
  const NodeCounts counts = count_nodes(TreeShape(rock.tree()), Side::a, t.events);
  CHECK(std::accumulate(counts.visits.begin(), counts.visits.end(), std::uint64_t{0}) == of_body);
  CHECK_THROWS_AS(walked_tree(rock, 1000), InputError);
}

TEST_CASE("the recorded axis of a rejected pair separates the nodes' boxes") {
  const BodyPair& bodies = watched_bodies()[0];
  const Recorded run = record(bodies, {}, EventLevel::nodes);
  std::size_t step = 0;
  for (EventId i = 0; i < run.trace.events.size(); ++i) {
    const Event& e = run.trace.events[i];
    if (e.kind == EventKind::step) step = run.trace.step_of(i);
    if (e.kind != EventKind::node_pair || e.work().met != 0) continue;
    const WorldBox box[2] = {box_of(bodies.a->tree(), e.a, kWhole, run.trace.steps[step].pose_a),
                             box_of(bodies.b->tree(), e.b, kWhole, run.trace.steps[step].pose_b)};
    const auto axis = static_cast<std::size_t>(e.node_end().axis);
    const Eigen::Vector3d n = box[axis / 3].across[axis % 3];
    double low[2], high[2];
    for (int s = 0; s < 2; ++s) {
      double reach = 0;
      for (const Eigen::Vector3d& half : box[s].half) reach += std::abs(n.dot(half));
      low[s] = n.dot(box[s].centre) - reach;
      high[s] = n.dot(box[s].centre) + reach;
    }
    const double gap = std::max(low[0] - high[1], low[1] - high[0]);
    CHECK((gap > 1e-12 || !e.node_end().apart));
    CHECK((gap < -1e-12 || e.node_end().apart || std::abs(gap) <= 1e-12));
  }
}

TEST_CASE("phases nest in steps, begin and end once, and have correct counts") {
  for (const CollideRequest& request : requests()) {
    const Recorded run = record(watched_bodies()[1], request, EventLevel::nodes);
    EventId open = kNull;
    std::map<Phase, int> ended;
    for (EventId i = 0; i < run.trace.events.size(); ++i) {
      const Event& e = run.trace.events[i];
      if (e.kind == EventKind::begin) {
        CHECK(open == kNull);
        open = i;
      }
      if (e.kind == EventKind::end) {
        CHECK(e.cause == open);
        CHECK(run.trace.events[open].phase() == e.phase());
        if (e.phase() == Phase::relation) {
          const auto points = std::count_if(run.trace.events.begin() + open, run.trace.events.begin() + i,
                                            [](const Event& p) { return p.kind == EventKind::point; });
          CHECK(points == e.b);
        }
        ++ended[e.phase()];
        open = kNull;
      }
      if (e.kind == EventKind::node_pair || e.kind == EventKind::point) CHECK(open != kNull);
    }
    CHECK(open == kNull);
    CHECK(ended[Phase::walk] >= 6);
    CHECK(ended[Phase::sort] >= 6);
    CHECK(ended[Phase::relation] >= 6);
    CHECK((ended[Phase::contacts] > 0) == request.contacts);
    CHECK((ended[Phase::separation] > 0) == request.separation);
  }
}

TEST_CASE("box tests of nodes are distributed to the faces below them") {
  for (const BodyPair& bodies : watched_bodies()) {
    const Recorded run = record(bodies, {}, EventLevel::nodes);
    std::uint64_t box_tests = 0;
    for (const CollideResult& r : run.results) box_tests += r.counters.box_tests;
    const LrbRep* const reps[] = {bodies.a, bodies.b};
    for (const Side side : {Side::a, Side::b}) {
      const LrbRep& rep = *reps[static_cast<int>(side)];
      const TreeShape tree(rep.tree());
      const NodeCounts counts = count_nodes(tree, side, run.trace.events);
      CHECK(std::accumulate(counts.box_tests.begin(), counts.box_tests.end(), std::uint64_t{0}) == box_tests);
      const std::vector<double> faces = box_tests_by_face(rep, tree, counts);
      CHECK(std::accumulate(faces.begin(), faces.end(), 0.0) ==
            doctest::Approx(static_cast<double>(box_tests)));
      std::uint64_t visits = 0, nodes = 0;
      const std::vector<DepthWork> depths = work_by_depth(tree, counts);
      for (const DepthWork& d : depths) visits += d.visits, nodes += d.nodes;
      CHECK(visits == std::accumulate(counts.visits.begin(), counts.visits.end(), std::uint64_t{0}));
      CHECK(nodes == rep.tree().nodes().size());
      CHECK(depths[0].expected == doctest::Approx(1));
      CHECK(depths.size() == rep.tree().height());
    }
  }
  Trace damaged = record(watched_bodies()[3], {}, EventLevel::nodes).trace;
  for (Event& e : damaged.events)
    if (e.kind == EventKind::node_pair) e.a = 1'000'000;
  CHECK_THROWS_AS(count_nodes(TreeShape(watched_bodies()[3].a->tree()), Side::a, damaged.events), InputError);
}
