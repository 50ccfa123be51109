/// The recorder on the real query.

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/lrb_shapes.hpp"
#include "tests/support/trace_schema.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using runs::BodyPair, runs::Recorded;

namespace {

std::vector<BodyPair> all_bodies() {
  static const LrbRep plate(toy::notched_plate()), box(toy::dented_box());
  static const LrbRep dent = shapes::dented_box(), stairs = shapes::stairs_2d();
  return {{&plate, &plate}, {&plate, &stairs}, {&box, &box}, {&dent, &box}};
}

std::vector<CollideRequest> all_requests() {
  std::vector<CollideRequest> out;
  for (const Recursion recursion :
       {Recursion::complete, Recursion::paper, Recursion::paper_strict, Recursion::paper_wrapper,
        Recursion::paper_boxes, Recursion::paper_wrapper_boxes})
    for (const WrapperMode wrapper : {WrapperMode::regularised, WrapperMode::unregularised})
      for (const Mode mode : {Mode::all_pairs, Mode::first_pair})
        out.push_back({.mode = mode, .recursion = recursion, .wrapper = wrapper});
  return out;
}

/// Each step also runs without the recorder and must give the same result.
Recorded record(const BodyPair& bodies, const CollideRequest& request, int steps) {
  Recorded out = runs::record(bodies, request, EventLevel::faces, 11, steps);
  for (std::size_t i = 0; i < out.results.size(); ++i) {
    const CollideResult plain = collide(*bodies.a, {}, *bodies.b, out.trace.steps[i].pose_b, request);
    CHECK(plain.pairs == out.results[i].pairs);
    CHECK(plain.relation == out.results[i].relation);
    CHECK(plain.opened == out.results[i].opened);
    CHECK(plain.counters == out.results[i].counters);
  }
  return out;
}

}  // namespace

TEST_CASE("recording changes no answer, is complete, and replays to the query's final wrappers") {
  std::size_t refinements = 0, contacts = 0;
  for (const CollideRequest& request : all_requests())
    for (const BodyPair& bodies : all_bodies()) {
      CAPTURE(std::string(name_of(request.recursion)));
      CAPTURE(std::string(name_of(request.wrapper)));
      CAPTURE(std::string(name_of(request.mode)));
      CAPTURE(bodies.b->name());
      const Recorded run = record(bodies, request, 25);
      CHECK(trace_from_json(trace_to_json(run.trace), "run") == run.trace);
      Cursor cursor(run.trace, *bodies.a, *bodies.b);
      for (std::size_t step = 0; step < run.results.size(); ++step) {
        const CollideResult& result = run.results[step];
        const std::span<const Event> events = run.trace.events_of(step);
        const Totals totals = count_events(events);
        CHECK(totals.face_tests == result.counters.face_tests);
        CHECK(totals.refinements[0] + totals.refinements[1] == result.counters.refinements);
        if (request.mode == Mode::all_pairs) CHECK(totals.contacts == result.pairs.size());
        cursor.seek(run.trace.steps[step].first_event + static_cast<EventId>(events.size()) - 1);
        CHECK(cursor.event().kind == EventKind::result);
        for (const Side side : {Side::a, Side::b})
          CHECK(cursor.wrapper(side).excluded() == result.opened[static_cast<std::size_t>(side)]);
        refinements += result.counters.refinements;
        contacts += totals.contacts;
      }
    }
  CHECK(refinements > 1000);
  CHECK(contacts > 1000);
}

TEST_CASE("a face test follows the refinement that added the later of its faces, its cause in the trace") {
  for (const CollideRequest& request : all_requests())
    for (const BodyPair& bodies : all_bodies()) {
      const Recorded run = record(bodies, request, 10);
      std::map<std::pair<Side, CellId>, EventId> refined;  // in this step: the event that added the faces
      for (const Event& e : run.trace.events) {
        if (e.kind == EventKind::step) refined.clear();
        if (e.kind == EventKind::refine) {
          refined.try_emplace({e.side, e.region()}, static_cast<EventId>(&e - run.trace.events.data()));
          CHECK((request.recursion == Recursion::complete) == (e.cause == kNull));
          if (e.cause == kNull) continue;
          const Event& test = run.trace.events[e.cause];
          const LrbRep& rep = e.side == Side::a ? *bodies.a : *bodies.b;
          CHECK(rep.inner_cell(rep.face_of_simplex(test.simplex(e.side))) == e.region());
        }
        if (e.kind == EventKind::contact) {
          REQUIRE(e.cause != kNull);
          CHECK(run.trace.events[e.cause].kind == EventKind::face_test);
        }
        if (e.kind != EventKind::face_test) continue;
        EventId later = kNull;  // of the refinements that added its faces
        for (const Side side : {Side::a, Side::b}) {
          const LrbRep& rep = side == Side::a ? *bodies.a : *bodies.b;
          const CellId cover = rep.outer_cell(rep.face_of_simplex(e.simplex(side)));
          const auto added = refined.find({side, cover});
          CHECK((added != refined.end()) == is_region(cover));
          if (added != refined.end() && (later == kNull || added->second > later)) later = added->second;
        }
        CHECK(e.cause == later);
      }
    }
}

TEST_CASE("approximate queries and certificates: the trace has the answers, and marks pseudo faces") {
  const LrbRep a = build_lrb(shapes::bumpy_sphere(2, 7, 0.3)), b = build_lrb(shapes::bumpy_sphere(2, 8, 0.3));
  const LrbRep flat_a = build_lrb(shapes::gear(24)), flat_b = build_lrb(shapes::gear(19, 0.9, 0.6));
  std::size_t pseudo = 0, unfinished = 0, unknown = 0, proofs = 0, earlier = 0;
  for (const BodyPair& bodies : {BodyPair{&a, &b}, BodyPair{&flat_a, &flat_b}})
    for (const CollideRequest& request :
         {CollideRequest{.tolerance = 0.5, .separation = true}, CollideRequest{.max_tests = 40},
          CollideRequest{.tolerance = 0.3, .max_tests = 300, .separation = true},
          CollideRequest{.mode = Mode::any_pair, .max_tests = 1}, CollideRequest{.separation = true}}) {
      CAPTURE(request.tolerance);
      CAPTURE(request.max_tests);
      const Recorded run = record(bodies, request, 25);
      const std::string json = trace_to_json(run.trace);
      CHECK(trace_from_json(json, "run") == run.trace);
      CHECK(test::trace_faults(nlohmann::json::parse(json)) == "");
      std::size_t pseudo_here = 0;
      for (std::size_t step = 0; step < run.results.size(); ++step) {
        const CollideResult& result = run.results[step];
        const StepResult& kept = run.trace.steps[step].result;
        CHECK(kept.error_bound == result.error_bound);
        CHECK(kept.finished == result.finished);
        CHECK(kept.separation == result.separation);
        unfinished += !kept.finished;
        unknown += std::isinf(kept.error_bound);
        proofs += kept.separation.has_value();
        std::vector<SimplexPair> pairs;
        for (const Event& e : run.trace.events_of(step)) {
          if (e.kind != EventKind::contact) continue;
          pairs.push_back({e.simplex(Side::a), e.simplex(Side::b)});
          pseudo_here += !bodies.a->is_real_simplex(e.simplex(Side::a));
          pseudo_here += !bodies.b->is_real_simplex(e.simplex(Side::b));
          REQUIRE(e.cause != kNull);
          const Event& test = run.trace.events[e.cause];
          CHECK(test.kind == EventKind::face_test);
          CHECK((test.a == e.a && test.b == e.b && test.meet == e.meet));
          earlier += run.trace.events[e.cause + 1].kind == EventKind::face_test;
        }
        std::sort(pairs.begin(), pairs.end());
        CHECK((pairs == result.pairs));
      }
      pseudo += pseudo_here;
      CHECK((json.find("\"pseudo simplex of ") != std::string::npos) == (pseudo_here > 0));
    }
  CHECK(pseudo > 100);
  CHECK(unfinished > 10);
  CHECK(unknown > 0);
  CHECK(proofs > 10);
  CHECK(earlier > 100);
}
